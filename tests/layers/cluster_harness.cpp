#include "layers/cluster_harness.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>

namespace tessera::test
{

namespace
{

#define EXPECT_VK(call) EXPECT_EQ(call, VK_SUCCESS)

bool offers(VkPhysicalDevice physical, const std::string& name)
{
	uint32_t count = 0;
	vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
	std::vector<VkExtensionProperties> all(count);
	vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, all.data());
	for (const auto& one : all)
		if (name == one.extensionName)
			return true;
	return false;
}

constexpr const char* kExtensions[] = { VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
										VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME, VK_NV_CLUSTER_ACCELERATION_STRUCTURE_EXTENSION_NAME };

VkInstance makeInstance()
{
	// Another layer, named by the person who runs this, may stand below: VK_LAYER_KHRONOS_validation, say.
	const char* below = std::getenv("TESSERA_TEST_LAYER_BELOW");
	setenv("VK_INSTANCE_LAYERS", (std::string("VK_LAYER_TESSERA_cluster_emulation") + (below ? std::string(":") + below : "")).c_str(), 1);
	setenv(below ? "VK_ADD_LAYER_PATH" : "VK_LAYER_PATH", TESSERA_LAYERS, 1);
	VkApplicationInfo application = { VK_STRUCTURE_TYPE_APPLICATION_INFO };
	application.apiVersion = VK_API_VERSION_1_3;
	VkInstanceCreateInfo info = { VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, nullptr, 0, &application };
	VkInstance instance = VK_NULL_HANDLE;
	EXPECT_VK(vkCreateInstance(&info, nullptr, &instance));
	return instance;
}

std::vector<uint32_t> shaderWords(const std::string& name)
{
	std::ifstream file(std::string(TESSERA_LAYER_SHADERS) + "/" + name + ".spv", std::ios::binary | std::ios::ate);
	std::vector<uint32_t> words(file ? size_t(file.tellg()) / 4 : 0);
	file.seekg(0);
	file.read(reinterpret_cast<char*>(words.data()), std::streamsize(words.size() * 4));
	EXPECT_FALSE(words.empty()) << name;
	return words;
}

}  // namespace

bool Gpu::open(bool feature)
{
	instance = makeInstance();
	uint32_t count = 1;
	if (!instance || vkEnumeratePhysicalDevices(instance, &count, &physical) < VK_SUCCESS || count == 0)
		return false;
	for (const char* name : kExtensions)
		if (!offers(physical, name))
			return false;
	cluster_properties = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_PROPERTIES_NV };
	ray_properties = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR, &cluster_properties };
	VkPhysicalDeviceProperties2 properties = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &ray_properties };
	vkGetPhysicalDeviceProperties2(physical, &properties);
	VkPhysicalDeviceClusterAccelerationStructureFeaturesNV clusters = {
		VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_FEATURES_NV
	};
	VkPhysicalDeviceFeatures2 offered = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &clusters };
	vkGetPhysicalDeviceFeatures2(physical, &offered);
	EXPECT_TRUE(clusters.clusterAccelerationStructure);
	clusters.clusterAccelerationStructure = feature;
	VkPhysicalDeviceAccelerationStructureFeaturesKHR structures = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
																	&clusters };
	structures.accelerationStructure = VK_TRUE;
	VkPhysicalDeviceRayTracingPipelineFeaturesKHR rays = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR, &structures };
	rays.rayTracingPipeline = VK_TRUE;
	VkPhysicalDeviceVulkan12Features vulkan12 = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &rays };
	vulkan12.bufferDeviceAddress = vulkan12.scalarBlockLayout = VK_TRUE;
	const float priority = 1.0f;
	VkDeviceQueueCreateInfo queues = { VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority };
	VkDeviceCreateInfo info = { VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &vulkan12, 0, 1, &queues };
	info.enabledExtensionCount = std::size(kExtensions);
	info.ppEnabledExtensionNames = kExtensions;
	EXPECT_VK(vkCreateDevice(physical, &info, nullptr, &device));
	if (!device)
		return false;
	vkGetDeviceQueue(device, 0, 0, &queue);
	const VkCommandPoolCreateInfo of = { VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO };
	EXPECT_VK(vkCreateCommandPool(device, &of, nullptr, &pool));
#define HARNESS_FUNCTION(name) EXPECT_TRUE(name = reinterpret_cast<PFN_vk##name>(vkGetDeviceProcAddr(device, "vk" #name)));
	HARNESS_FUNCTIONS(HARNESS_FUNCTION)
#undef HARNESS_FUNCTION
	return true;
}

std::unique_ptr<Gpu> Gpu::make(bool feature)
{
	std::unique_ptr<Gpu> gpu(new Gpu);
	return gpu->open(feature) ? std::move(gpu) : nullptr;
}

Gpu::~Gpu()
{
	if (device)
	{
		vkDestroyCommandPool(device, pool, nullptr);
		vkDestroyDevice(device, nullptr);
	}
	if (instance)
		vkDestroyInstance(instance, nullptr);
}

void Gpu::run(const std::function<void(VkCommandBuffer)>& record)
{
	VkCommandBufferAllocateInfo allocation = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool };
	allocation.commandBufferCount = 1;
	VkCommandBuffer commands = VK_NULL_HANDLE;
	EXPECT_VK(vkAllocateCommandBuffers(device, &allocation, &commands));
	const VkCommandBufferBeginInfo begin = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
	EXPECT_VK(vkBeginCommandBuffer(commands, &begin));
	record(commands);
	EXPECT_VK(vkEndCommandBuffer(commands));
	VkSubmitInfo submit = { VK_STRUCTURE_TYPE_SUBMIT_INFO };
	submit.commandBufferCount = 1;
	submit.pCommandBuffers = &commands;
	const VkFenceCreateInfo of = { VK_STRUCTURE_TYPE_FENCE_CREATE_INFO };
	VkFence fence = VK_NULL_HANDLE;
	EXPECT_VK(vkCreateFence(device, &of, nullptr, &fence));
	EXPECT_VK(vkQueueSubmit(queue, 1, &submit, fence));
	EXPECT_VK(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX));
	vkDestroyFence(device, fence, nullptr);
	vkFreeCommandBuffers(device, pool, 1, &commands);
}

uint32_t Gpu::memoryType(uint32_t allowed) const
{
	VkPhysicalDeviceMemoryProperties memory = {};
	vkGetPhysicalDeviceMemoryProperties(physical, &memory);
	constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
	for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
		if ((allowed >> i & 1u) && (memory.memoryTypes[i].propertyFlags & kHost) == kHost)
			return i;
	ADD_FAILURE() << "no memory that the host sees";
	return 0;
}

Buffer::Buffer(Gpu& gpu, VkDeviceSize bytes, VkBufferUsageFlags usage) : size(bytes ? bytes : 4), gpu_(gpu)
{
	VkBufferCreateInfo info = { VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO };
	info.size = size;
	info.usage = usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
	EXPECT_VK(vkCreateBuffer(gpu.device, &info, nullptr, &handle));
	VkMemoryRequirements needs = {};
	vkGetBufferMemoryRequirements(gpu.device, handle, &needs);
	VkMemoryAllocateFlagsInfo flags = { VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO };
	flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
	const VkMemoryAllocateInfo allocation = { VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags, needs.size, gpu.memoryType(needs.memoryTypeBits) };
	EXPECT_VK(vkAllocateMemory(gpu.device, &allocation, nullptr, &memory_));
	EXPECT_VK(vkBindBufferMemory(gpu.device, handle, memory_, 0));
	void* mapped = nullptr;
	EXPECT_VK(vkMapMemory(gpu.device, memory_, 0, VK_WHOLE_SIZE, 0, &mapped));
	data = static_cast<std::byte*>(mapped);
	std::memset(data, 0, size);
	const VkBufferDeviceAddressInfo of = { VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, handle };
	address = vkGetBufferDeviceAddress(gpu.device, &of);
}

Buffer::~Buffer()
{
	vkDestroyBuffer(gpu_.device, handle, nullptr);
	vkFreeMemory(gpu_.device, memory_, nullptr);
}

Structure::Structure(Gpu& gpu, VkAccelerationStructureTypeKHR type, std::span<const VkAccelerationStructureGeometryKHR> geometries,
					 std::span<const VkAccelerationStructureBuildRangeInfoKHR> ranges)
	: gpu_(gpu)
{
	VkAccelerationStructureBuildGeometryInfoKHR build = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR };
	build.type = type;
	build.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
	build.geometryCount = static_cast<uint32_t>(geometries.size());
	build.pGeometries = geometries.data();
	std::vector<uint32_t> counts;
	for (const auto& range : ranges)
		counts.push_back(range.primitiveCount);
	VkAccelerationStructureBuildSizesInfoKHR sizes = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR };
	gpu.GetAccelerationStructureBuildSizesKHR(gpu.device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &build, counts.data(), &sizes);
	storage_ = std::make_unique<Buffer>(gpu, sizes.accelerationStructureSize);
	Buffer scratch(gpu, sizes.buildScratchSize + 256);
	VkAccelerationStructureCreateInfoKHR info = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR };
	info.buffer = storage_->handle;
	info.size = sizes.accelerationStructureSize;
	info.type = type;
	EXPECT_VK(gpu.CreateAccelerationStructureKHR(gpu.device, &info, nullptr, &handle));
	build.dstAccelerationStructure = handle;
	build.scratchData.deviceAddress = (scratch.address + 255) / 256 * 256;
	const VkAccelerationStructureBuildRangeInfoKHR* first = ranges.data();
	gpu.run([&](VkCommandBuffer commands) { gpu.CmdBuildAccelerationStructuresKHR(commands, 1, &build, &first); });
	VkAccelerationStructureDeviceAddressInfoKHR of = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR };
	of.accelerationStructure = handle;
	address = gpu.GetAccelerationStructureDeviceAddressKHR(gpu.device, &of);
}

Structure::~Structure()
{
	gpu_.DestroyAccelerationStructureKHR(gpu_.device, handle, nullptr);
}

std::unique_ptr<Structure> topLevel(Gpu& gpu, std::span<const VkAccelerationStructureInstanceKHR> instances)
{
	Buffer data(gpu, std::vector(instances.begin(), instances.end()));
	VkAccelerationStructureGeometryKHR geometry = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR };
	geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
	geometry.geometry.instances = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR };
	geometry.geometry.instances.data.deviceAddress = data.address;
	const VkAccelerationStructureBuildRangeInfoKHR range = { static_cast<uint32_t>(instances.size()), 0, 0, 0 };
	return std::make_unique<Structure>(gpu, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, std::span(&geometry, 1), std::span(&range, 1));
}

void fullBarrier(VkCommandBuffer commands)
{
	VkMemoryBarrier all = { VK_STRUCTURE_TYPE_MEMORY_BARRIER };
	all.srcAccessMask = all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
	vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &all, 0, nullptr, 0, nullptr);
}

namespace
{

struct PushConstants
{
	VkDeviceAddress hits;
	float extent;
};

// Everything that tracing needs, made for one call.
class Tracer
{
public:
	Tracer(Gpu& gpu, const Structure& scene, const char* closest_hit) : gpu_(gpu)
	{
		makeLayouts();
		makeSet(scene);
		makePipeline({ "trace.rgen", "trace.rmiss", closest_hit });
		makeTable();
	}
	~Tracer()
	{
		vkDestroyPipeline(gpu_.device, pipeline_, nullptr);
		vkDestroyPipelineLayout(gpu_.device, layout_, nullptr);
		vkDestroyDescriptorPool(gpu_.device, pool_, nullptr);
		vkDestroyDescriptorSetLayout(gpu_.device, set_layout_, nullptr);
	}
	Tracer(const Tracer&) = delete;
	Tracer& operator=(const Tracer&) = delete;

	void record(VkCommandBuffer commands, const PushConstants& args, uint32_t side, const std::function<void(VkCommandBuffer)>& between) const
	{
		vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline_);
		vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, layout_, 0, 1, &set_, 0, nullptr);
		vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_RAYGEN_BIT_KHR, 0, 12, &args);
		if (between)
			between(commands);
		const VkStridedDeviceAddressRegionKHR none = {};
		gpu_.CmdTraceRaysKHR(commands, &regions_[0], &regions_[1], &regions_[2], &none, side, side, 1);
	}

private:
	void makeLayouts()
	{
		const VkDescriptorSetLayoutBinding binding = { 0, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1, VK_SHADER_STAGE_RAYGEN_BIT_KHR, nullptr };
		const VkDescriptorSetLayoutCreateInfo sets = { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0, 1, &binding };
		EXPECT_VK(vkCreateDescriptorSetLayout(gpu_.device, &sets, nullptr, &set_layout_));
		const VkPushConstantRange push = { VK_SHADER_STAGE_RAYGEN_BIT_KHR, 0, 12 };
		const VkPipelineLayoutCreateInfo info = { VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, &set_layout_, 1, &push };
		EXPECT_VK(vkCreatePipelineLayout(gpu_.device, &info, nullptr, &layout_));
	}
	void makeSet(const Structure& scene)
	{
		const VkDescriptorPoolSize size = { VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1 };
		const VkDescriptorPoolCreateInfo pool = { VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, 1, &size };
		EXPECT_VK(vkCreateDescriptorPool(gpu_.device, &pool, nullptr, &pool_));
		const VkDescriptorSetAllocateInfo info = { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool_, 1, &set_layout_ };
		EXPECT_VK(vkAllocateDescriptorSets(gpu_.device, &info, &set_));
		const VkWriteDescriptorSetAccelerationStructureKHR structure = { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR, nullptr,
																		 1, &scene.handle };
		const VkWriteDescriptorSet write = { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,       &structure, set_, 0, 0, 1,
											 VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR };
		vkUpdateDescriptorSets(gpu_.device, 1, &write, 0, nullptr);
	}
	void makePipeline(const std::array<const char*, 3>& shaders)
	{
		constexpr VkShaderStageFlagBits kStages[] = { VK_SHADER_STAGE_RAYGEN_BIT_KHR, VK_SHADER_STAGE_MISS_BIT_KHR,
													  VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR };
		std::array<VkPipelineShaderStageCreateInfo, 3> stages = {};
		std::array<VkRayTracingShaderGroupCreateInfoKHR, 3> groups = {};
		for (uint32_t i = 0; i < 3; ++i)
		{
			const std::vector<uint32_t> words = shaderWords(shaders[i]);
			const VkShaderModuleCreateInfo module = { VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, words.size() * 4, words.data() };
			stages[i] = { VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, kStages[i], VK_NULL_HANDLE, "main", nullptr };
			EXPECT_VK(vkCreateShaderModule(gpu_.device, &module, nullptr, &stages[i].module));
			groups[i] = { VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
						  nullptr,
						  i < 2 ? VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR : VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR,
						  i < 2 ? i : VK_SHADER_UNUSED_KHR,
						  i < 2 ? VK_SHADER_UNUSED_KHR : i,
						  VK_SHADER_UNUSED_KHR,
						  VK_SHADER_UNUSED_KHR };
		}
		VkRayTracingPipelineClusterAccelerationStructureCreateInfoNV clusters = {
			VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CLUSTER_ACCELERATION_STRUCTURE_CREATE_INFO_NV, nullptr, VK_TRUE
		};
		VkRayTracingPipelineCreateInfoKHR info = { VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR, &clusters };
		info.stageCount = info.groupCount = 3;
		info.pStages = stages.data();
		info.pGroups = groups.data();
		info.maxPipelineRayRecursionDepth = 1;
		info.layout = layout_;
		EXPECT_VK(gpu_.CreateRayTracingPipelinesKHR(gpu_.device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_));
		for (const auto& stage : stages)
			vkDestroyShaderModule(gpu_.device, stage.module, nullptr);
	}
	void makeTable()
	{
		const uint32_t handle = gpu_.ray_properties.shaderGroupHandleSize, stride = (handle + 63) / 64 * 64;
		std::vector<std::byte> handles(size_t(3) * handle);
		EXPECT_VK(gpu_.GetRayTracingShaderGroupHandlesKHR(gpu_.device, pipeline_, 0, 3, handles.size(), handles.data()));
		table_ = std::make_unique<Buffer>(gpu_, 3 * stride + 64);
		const VkDeviceSize start = (64 - table_->address % 64) % 64;
		for (uint32_t i = 0; i < 3; ++i)
		{
			std::memcpy(table_->data + start + i * stride, handles.data() + size_t(i) * handle, handle);
			regions_[i] = { table_->address + start + i * stride, stride, stride };
		}
	}

	Gpu& gpu_;
	VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
	VkPipelineLayout layout_ = VK_NULL_HANDLE;
	VkDescriptorPool pool_ = VK_NULL_HANDLE;
	VkDescriptorSet set_ = VK_NULL_HANDLE;
	VkPipeline pipeline_ = VK_NULL_HANDLE;
	std::unique_ptr<Buffer> table_;
	std::array<VkStridedDeviceAddressRegionKHR, 3> regions_ = {};
};

}  // namespace

std::vector<Hit> trace(Gpu& gpu, const Structure& scene, const char* closest_hit, float extent, uint32_t side,
					   const std::function<void(VkCommandBuffer)>& between)
{
	const Tracer tracer(gpu, scene, closest_hit);
	const Buffer hits(gpu, size_t(side) * side * sizeof(Hit));
	gpu.run([&](VkCommandBuffer commands) { tracer.record(commands, { hits.address, extent }, side, between); });
	return hits.read<Hit>(size_t(side) * side);
}

}  // namespace tessera::test
