// What the layer knows of an instance and of a device, found by the key that the loader puts at the start of every dispatchable handle.
#pragma once
#include "layer/address_map.h"
#include "layer/functions.h"
#include "layer/host_link.h"
#include "layer/lookup_table.h"
#include "layer/recording.h"
#include "layer/report.h"
#include "layer/structures.h"

#include <memory>
#include <mutex>
#include <unordered_map>
#include <unordered_set>

namespace tessera::layer
{

struct Instance
{
	VkInstance handle = VK_NULL_HANDLE;
	InstanceFunctions next;
};

// What the layer reports: the numbers of the RTX cards that have the extension, as far as they are known.
VkPhysicalDeviceClusterAccelerationStructurePropertiesNV clusterProperties();

// Can the layer offer the extension there?
bool canEmulate(const Instance& instance, VkPhysicalDevice physical);

struct Device
{
	VkDevice handle = VK_NULL_HANDLE;
	VkPhysicalDevice physical = VK_NULL_HANDLE;
	Instance* instance = nullptr;
	bool active = false;      // the program enabled the extension; otherwise everything is passed on untouched
	bool feature_on = false;  // and its feature
	DeviceFunctions next;
	PFN_vkSetDeviceLoaderData set_loader_data = nullptr;
	VkPhysicalDeviceMemoryProperties memory = {};
	Report report;
	AddressMap addresses;
	Recordings recordings;
	Structures structures;
	std::unique_ptr<LookupTable> lookup;
	std::mutex submit_lock;  // one thread at a time does what the device would do
	std::unordered_map<VkQueue, uint32_t> queue_families;
	std::unordered_map<uint32_t, std::unique_ptr<HostLink>> links;  // by queue family
	std::mutex object_lock;
	std::unordered_set<VkPipeline> pipelines_without_clusters;  // ray tracing pipelines that were not made to meet clusters
	std::unordered_set<VkShaderModule> cluster_modules;         // those that read gl_ClusterIDNV
};

// Of any handle of that instance or device. Valid until it is destroyed.
Instance& instanceOf(const void* dispatchable);
Device& deviceOf(const void* dispatchable);

// Entry points that device.cpp and physical_device.cpp give to the table in entry.cpp.
VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator, VkInstance* instance);
VKAPI_ATTR void VKAPI_CALL destroyInstance(VkInstance instance, const VkAllocationCallbacks* allocator);
VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* allocator,
											VkDevice* device);
VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* allocator);
VKAPI_ATTR void VKAPI_CALL getDeviceQueue(VkDevice device, uint32_t family, uint32_t index, VkQueue* queue);
VKAPI_ATTR void VKAPI_CALL getDeviceQueue2(VkDevice device, const VkDeviceQueueInfo2* info, VkQueue* queue);
VKAPI_ATTR VkResult VKAPI_CALL enumerateDeviceExtensionProperties(VkPhysicalDevice physical, const char* layer, uint32_t* count,
																  VkExtensionProperties* properties);
VKAPI_ATTR void VKAPI_CALL getPhysicalDeviceFeatures2(VkPhysicalDevice physical, VkPhysicalDeviceFeatures2* features);
VKAPI_ATTR void VKAPI_CALL getPhysicalDeviceProperties2(VkPhysicalDevice physical, VkPhysicalDeviceProperties2* properties);

}  // namespace tessera::layer
