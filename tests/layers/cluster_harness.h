// A device under the cluster layer, and the little of Vulkan that its tests need.
#pragma once
#include <vulkan/vulkan.h>

#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tessera::test
{

#define HARNESS_FUNCTIONS(X)                       \
	X(CreateAccelerationStructureKHR)              \
	X(DestroyAccelerationStructureKHR)             \
	X(GetAccelerationStructureBuildSizesKHR)       \
	X(GetAccelerationStructureDeviceAddressKHR)    \
	X(CmdBuildAccelerationStructuresKHR)           \
	X(CreateRayTracingPipelinesKHR)                \
	X(GetRayTracingShaderGroupHandlesKHR)          \
	X(CmdTraceRaysKHR)                             \
	X(GetClusterAccelerationStructureBuildSizesNV) \
	X(CmdBuildClusterAccelerationStructureIndirectNV)

class Gpu
{
public:
	// Null when the device cannot trace rays. `feature`: enable the cluster feature with the extension, as one must.
	static std::unique_ptr<Gpu> make(bool feature = true);
	~Gpu();
	Gpu(const Gpu&) = delete;
	Gpu& operator=(const Gpu&) = delete;

	// Submits and waits.
	void run(const std::function<void(VkCommandBuffer)>& record);
	uint32_t memoryType(uint32_t allowed) const;

	VkInstance instance = VK_NULL_HANDLE;
	VkPhysicalDevice physical = VK_NULL_HANDLE;
	VkDevice device = VK_NULL_HANDLE;
	VkQueue queue = VK_NULL_HANDLE;
	VkCommandPool pool = VK_NULL_HANDLE;
	VkPhysicalDeviceClusterAccelerationStructurePropertiesNV cluster_properties = {};
	VkPhysicalDeviceRayTracingPipelinePropertiesKHR ray_properties = {};
	bool has_queries = false;
#define HARNESS_FUNCTION(name) PFN_vk##name name = nullptr;
	HARNESS_FUNCTIONS(HARNESS_FUNCTION)
#undef HARNESS_FUNCTION

private:
	Gpu() = default;
	bool open(bool feature);
};

// Memory that the host sees, with an address.
class Buffer
{
public:
	static constexpr VkBufferUsageFlags kAll = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
											   VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
											   VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

	Buffer(Gpu& gpu, VkDeviceSize size, VkBufferUsageFlags usage = kAll);
	template <typename Type>
	Buffer(Gpu& gpu, const std::vector<Type>& values, VkBufferUsageFlags usage = kAll) : Buffer(gpu, values.size() * sizeof(Type), usage)
	{
		if (!values.empty())
			std::memcpy(data, values.data(), values.size() * sizeof(Type));
	}
	~Buffer();
	Buffer(const Buffer&) = delete;
	Buffer& operator=(const Buffer&) = delete;

	template <typename Type>
	std::vector<Type> read(size_t count) const
	{
		std::vector<Type> values(count);
		std::memcpy(values.data(), data, count * sizeof(Type));
		return values;
	}

	VkBuffer handle = VK_NULL_HANDLE;
	VkDeviceAddress address = 0;
	VkDeviceSize size = 0;
	std::byte* data = nullptr;

private:
	Gpu& gpu_;
	VkDeviceMemory memory_ = VK_NULL_HANDLE;
};

// An acceleration structure of the KHR extension, built.
class Structure
{
public:
	Structure(Gpu& gpu, VkAccelerationStructureTypeKHR type, std::span<const VkAccelerationStructureGeometryKHR> geometries,
			  std::span<const VkAccelerationStructureBuildRangeInfoKHR> ranges);
	~Structure();
	Structure(const Structure&) = delete;
	Structure& operator=(const Structure&) = delete;

	VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
	VkDeviceAddress address = 0;

private:
	Gpu& gpu_;
	std::unique_ptr<Buffer> storage_;
};

// VkResult must be success.
#define EXPECT_VK(call) EXPECT_EQ(call, VK_SUCCESS)

// Of these instances; `wrong_address`: told to be there instead.
std::unique_ptr<Structure> topLevel(Gpu& gpu, std::span<const VkAccelerationStructureInstanceKHR> instances, VkDeviceAddress wrong_address = 0);

void fullBarrier(VkCommandBuffer commands);

}  // namespace tessera::test
