#include "layers/cluster_harness.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace tessera::test
{

namespace
{

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
	VkPhysicalDeviceRayQueryFeaturesKHR queries = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR, &rays };
	queries.rayQuery = VK_TRUE;
	has_queries = offers(physical, VK_KHR_RAY_QUERY_EXTENSION_NAME);
	void* chain = has_queries ? static_cast<void*>(&queries) : &rays;
	VkPhysicalDeviceVulkan13Features vulkan13 = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, chain };
	vulkan13.dynamicRendering = VK_TRUE;
	vulkan13.maintenance4 = VK_TRUE;  // glslang's workgroup sizes
	VkPhysicalDeviceVulkan12Features vulkan12 = { VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &vulkan13 };
	vulkan12.bufferDeviceAddress = vulkan12.scalarBlockLayout = VK_TRUE;
	const float priority = 1.0f;
	VkDeviceQueueCreateInfo queue_info = { VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority };
	VkDeviceCreateInfo info = { VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &vulkan12, 0, 1, &queue_info };
	std::vector<const char*> extensions(std::begin(kExtensions), std::end(kExtensions));
	if (has_queries)
		extensions.push_back(VK_KHR_RAY_QUERY_EXTENSION_NAME);
	info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
	info.ppEnabledExtensionNames = extensions.data();
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

std::unique_ptr<Structure> topLevel(Gpu& gpu, std::span<const VkAccelerationStructureInstanceKHR> instances, VkDeviceAddress wrong_address)
{
	Buffer data(gpu, std::vector(instances.begin(), instances.end()));
	VkAccelerationStructureGeometryKHR geometry = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR };
	geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
	geometry.geometry.instances = { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR };
	geometry.geometry.instances.data.deviceAddress = wrong_address ? wrong_address : data.address;
	const VkAccelerationStructureBuildRangeInfoKHR range = { static_cast<uint32_t>(instances.size()), 0, 0, 0 };
	return std::make_unique<Structure>(gpu, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, std::span(&geometry, 1), std::span(&range, 1));
}

void fullBarrier(VkCommandBuffer commands)
{
	VkMemoryBarrier all = { VK_STRUCTURE_TYPE_MEMORY_BARRIER };
	all.srcAccessMask = all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
	vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &all, 0, nullptr, 0, nullptr);
}

}  // namespace tessera::test
