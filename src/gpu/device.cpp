#include "gpu/device.h"

#include "base/keep_loaded.h"
#include "base/log.h"
#include "gpu/allocator.h"
#include "gpu/device_features.h"
#include "gpu/pipeline_store.h"

#include <algorithm>
#include <cstring>

namespace tessera
{

namespace
{

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

// The validation layer of Debian 12 does not know structures newer than itself and says so for every one.
bool isKnownNoise(const VkDebugUtilsMessengerCallbackDataEXT& data)
{
	return data.pMessageIdName && std::strcmp(data.pMessageIdName, "VUID-VkDeviceCreateInfo-pNext-pNext") == 0;
}

VKAPI_ATTR VkBool32 VKAPI_CALL onValidationMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
												   const VkDebugUtilsMessengerCallbackDataEXT* data, void* user)
{
	if (isKnownNoise(*data))
		return VK_FALSE;
	++static_cast<Device*>(user)->validation_messages_;
	logWarning("validation: {}", data->pMessage);
	return VK_FALSE;
}

bool hasInstanceExtension(const char* name)
{
	uint32_t count = 0;
	vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
	std::vector<VkExtensionProperties> properties(count);
	vkEnumerateInstanceExtensionProperties(nullptr, &count, properties.data());
	return std::any_of(properties.begin(), properties.end(), [&](const auto& p) { return std::strcmp(p.extensionName, name) == 0; });
}

bool hasLayer(const char* name)
{
	uint32_t count = 0;
	vkEnumerateInstanceLayerProperties(&count, nullptr);
	std::vector<VkLayerProperties> properties(count);
	vkEnumerateInstanceLayerProperties(&count, properties.data());
	return std::any_of(properties.begin(), properties.end(), [&](const auto& p) { return std::strcmp(p.layerName, name) == 0; });
}

Result<VkInstance> createInstance(bool validate, const std::vector<const char*>& more_extensions = {})
{
	VkApplicationInfo application = { VK_STRUCTURE_TYPE_APPLICATION_INFO };
	application.pApplicationName = "tessera";
	application.apiVersion = VK_API_VERSION_1_3;

	std::vector<const char*> extensions = more_extensions;
	if (hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME) || validate)
		extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
	std::vector<const char*> layers;
	if (validate)
	{
		if (!hasLayer(kValidationLayer))
			return fail(ExitCode::DeviceCannot, "--validate: the layer {} is not installed (package vulkan-validationlayers)", kValidationLayer);
		keepLoadedForLeakReports("libVkLayer_khronos_validation.so");
		layers.push_back(kValidationLayer);
	}
	const VkValidationFeatureEnableEXT enables[] = { VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT };
	VkValidationFeaturesEXT validation = { VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT };
	validation.enabledValidationFeatureCount = 1;
	validation.pEnabledValidationFeatures = enables;

	VkInstanceCreateInfo info = { VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO };
	info.pNext = validate ? &validation : nullptr;
	info.pApplicationInfo = &application;
	info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
	info.ppEnabledExtensionNames = extensions.data();
	info.enabledLayerCount = static_cast<uint32_t>(layers.size());
	info.ppEnabledLayerNames = layers.data();
	VkInstance instance = VK_NULL_HANDLE;
	VK_TRY(vkCreateInstance(&info, nullptr, &instance), "creating the Vulkan 1.3 instance");
	return instance;
}

std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance)
{
	uint32_t count = 0;
	vkEnumeratePhysicalDevices(instance, &count, nullptr);
	std::vector<VkPhysicalDevice> devices(count);
	vkEnumeratePhysicalDevices(instance, &count, devices.data());
	devices.resize(count);
	return devices;
}

VkPhysicalDeviceProperties propertiesOf(VkPhysicalDevice physical)
{
	VkPhysicalDeviceProperties properties;
	vkGetPhysicalDeviceProperties(physical, &properties);
	return properties;
}

int rankOf(VkPhysicalDevice physical)
{
	switch (propertiesOf(physical).deviceType)
	{
	case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
		return 4;
	case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
		return 3;
	case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
		return 2;
	case VK_PHYSICAL_DEVICE_TYPE_CPU:
		return 1;
	default:
		return 0;
	}
}

std::string describeDevices(const std::vector<VkPhysicalDevice>& devices)
{
	std::string text;
	for (size_t i = 0; i < devices.size(); ++i)
		text += fmt::format("{}{}: {}", i ? ", " : "", i, propertiesOf(devices[i]).deviceName);
	return text.empty() ? "none" : text;
}

Result<VkPhysicalDevice> chooseDevice(VkInstance instance, const std::string& wanted)
{
	const std::vector<VkPhysicalDevice> devices = physicalDevices(instance);
	if (devices.empty())
		return fail(ExitCode::DeviceCannot, "no Vulkan device: install a driver (package mesa-vulkan-drivers has one for the processor)");
	if (wanted.empty())
		return *std::max_element(devices.begin(), devices.end(), [](auto a, auto b) { return rankOf(a) < rankOf(b); });
	for (size_t i = 0; i < devices.size(); ++i)
		if (wanted == std::to_string(i) || std::string(propertiesOf(devices[i]).deviceName).find(wanted) != std::string::npos)
			return devices[i];
	return fail(ExitCode::DeviceCannot, "--device {}: no such device; there are: {}", wanted, describeDevices(devices));
}

Result<uint32_t> chooseQueueFamily(VkInstance instance, VkPhysicalDevice physical, const DeviceRequest& request)
{
	uint32_t count = 0;
	vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
	std::vector<VkQueueFamilyProperties> families(count);
	vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
	constexpr VkQueueFlags kWanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
	for (uint32_t i = 0; i < count; ++i)
		if ((families[i].queueFlags & kWanted) == kWanted && (!request.can_present || request.can_present(instance, physical, i)))
			return i;
	if (request.can_present)
		return fail(ExitCode::DeviceCannot, "{}: cannot show pictures in a window; `tessera render` needs none, --device takes another",
					propertiesOf(physical).deviceName);
	return fail(ExitCode::DeviceCannot, "{}: no queue with graphics and compute", propertiesOf(physical).deviceName);
}

}  // namespace

// Builds a Device step by step; each step leaves it destructible.
struct DeviceBuilder
{
	static void createMessenger(Device& device)
	{
		VkDebugUtilsMessengerCreateInfoEXT info = { VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT };
		info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
		info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
		info.pfnUserCallback = onValidationMessage;
		info.pUserData = &device;
		const auto create =
			reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(device.instance, "vkCreateDebugUtilsMessengerEXT"));
		if (create)
			create(device.instance, &info, nullptr, &device.messenger_);
	}

	static Status createLogicalDevice(Device& device, const DeviceRequest& request)
	{
		TRY_ASSIGN(device.queue_family, chooseQueueFamily(device.instance, device.physical, request));
		DeviceFeatures features;
		TRY(features.query(device.physical, device.name));
		device.gates = features.gates();
		if (device.gates.cluster_acceleration_structure)
			device.limits.clusters = clusterLimitsOf(device.physical);
		device.gates.debug_names = hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

		const float priority = 1;
		VkDeviceQueueCreateInfo queue = { VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO };
		queue.queueFamilyIndex = device.queue_family;
		queue.queueCount = 1;
		queue.pQueuePriorities = &priority;
		VkDeviceCreateInfo info = { VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO };
		info.pNext = features.enabledChain(request.pipeline_statistics);
		device.pipeline_statistics = request.pipeline_statistics && device.gates.pipeline_statistics;
		info.queueCreateInfoCount = 1;
		info.pQueueCreateInfos = &queue;
		std::vector<const char*> extensions = features.extensions();
		if (request.can_present)
			extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
		info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
		info.ppEnabledExtensionNames = extensions.data();
		VK_TRY(vkCreateDevice(device.physical, &info, nullptr, &device.handle), "{}: creating the device", device.name);
		vkGetDeviceQueue(device.handle, device.queue_family, 0, &device.queue);
		return {};
	}

	template <typename Function>
	static void load(const Device& device, Function& function, const char* name)
	{
		function = reinterpret_cast<Function>(vkGetDeviceProcAddr(device.handle, name));
	}

	static void loadFunctions(Device& device)
	{
		if (device.gates.mesh_shader)
			load(device, device.functions.draw_mesh_tasks_indirect, "vkCmdDrawMeshTasksIndirectEXT");
		if (device.gates.rays())
		{
			ExtensionFunctions& functions = device.functions;
			load(device, functions.create_acceleration_structure, "vkCreateAccelerationStructureKHR");
			load(device, functions.destroy_acceleration_structure, "vkDestroyAccelerationStructureKHR");
			load(device, functions.acceleration_structure_sizes, "vkGetAccelerationStructureBuildSizesKHR");
			load(device, functions.acceleration_structure_address, "vkGetAccelerationStructureDeviceAddressKHR");
			load(device, functions.build_acceleration_structures, "vkCmdBuildAccelerationStructuresKHR");
			load(device, functions.copy_acceleration_structure, "vkCmdCopyAccelerationStructureKHR");
			load(device, functions.write_structure_properties, "vkCmdWriteAccelerationStructuresPropertiesKHR");
			load(device, functions.create_ray_tracing_pipelines, "vkCreateRayTracingPipelinesKHR");
			load(device, functions.ray_tracing_group_handles, "vkGetRayTracingShaderGroupHandlesKHR");
			load(device, functions.trace_rays, "vkCmdTraceRaysKHR");
		}
#ifdef VK_NV_cluster_acceleration_structure
		if (device.gates.cluster_acceleration_structure)
		{
			load(device, device.functions.cluster_structure_sizes, "vkGetClusterAccelerationStructureBuildSizesNV");
			load(device, device.functions.build_cluster_structures, "vkCmdBuildClusterAccelerationStructureIndirectNV");
		}
#endif
		if (device.pipeline_statistics)
		{
			load(device, device.functions.executable_properties, "vkGetPipelineExecutablePropertiesKHR");
			load(device, device.functions.executable_statistics, "vkGetPipelineExecutableStatisticsKHR");
		}
		if (device.gates.debug_names)
		{
			load(device, device.functions.set_object_name, "vkSetDebugUtilsObjectNameEXT");
			load(device, device.functions.begin_label, "vkCmdBeginDebugUtilsLabelEXT");
			load(device, device.functions.end_label, "vkCmdEndDebugUtilsLabelEXT");
		}
	}
};

Result<std::unique_ptr<Device>> Device::create(const DeviceRequest& request)
{
	std::unique_ptr<Device> device(new Device);
	TRY_ASSIGN(device->instance, createInstance(request.validate, request.instance_extensions));
	if (request.validate)
		DeviceBuilder::createMessenger(*device);
	TRY_ASSIGN(device->physical, chooseDevice(device->instance, request.name));
	describeDevice(*device);
	TRY(DeviceBuilder::createLogicalDevice(*device, request));
	DeviceBuilder::loadFunctions(*device);
	TRY_ASSIGN(device->allocator, createAllocator(*device));
	VkPipelineCacheCreateInfo cache = { VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO };
	VK_TRY(vkCreatePipelineCache(device->handle, &cache, nullptr, &device->pipeline_cache), "creating the pipeline cache");
	TRY_ASSIGN(device->pipelines, PipelineStore::create(*device));
	return device;
}

Device::Device() = default;

Device::~Device()
{
	if (handle)
	{
		vkDeviceWaitIdle(handle);
		pipelines.reset();
		vkDestroyPipelineCache(handle, pipeline_cache, nullptr);
		destroyAllocator(allocator);
		vkDestroyDevice(handle, nullptr);
	}
	if (messenger_)
		reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"))(
			instance, messenger_, nullptr);
	if (instance)
		vkDestroyInstance(instance, nullptr);
}

void Device::nameObject(VkObjectType type, uint64_t object, const std::string& object_name) const
{
	if (!functions.set_object_name)
		return;
	VkDebugUtilsObjectNameInfoEXT info = { VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT };
	info.objectType = type;
	info.objectHandle = object;
	info.pObjectName = object_name.c_str();
	functions.set_object_name(handle, &info);
}

Result<std::vector<std::string>> listDevices()
{
	TRY_ASSIGN(const VkInstance instance, createInstance(false));
	std::vector<std::string> lines;
	for (VkPhysicalDevice physical : physicalDevices(instance))
		lines.emplace_back(propertiesOf(physical).deviceName);
	vkDestroyInstance(instance, nullptr);
	return lines;
}

}  // namespace tessera
