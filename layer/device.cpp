// Creation and end of instances and devices, and their tables of functions.
#include "layer/device.h"

#include "layer/chain.h"

#include <cstring>
#include <shared_mutex>
#include <string>
#include <vector>

namespace tessera::layer
{

namespace
{

std::shared_mutex objects_lock;
std::unordered_map<const void*, std::unique_ptr<Instance>> instances;
std::unordered_map<const void*, std::unique_ptr<Device>> devices;

const void* keyOf(const void* dispatchable)
{
	return *static_cast<const void* const*>(dispatchable);
}

// A loader's structure of a create info's chain.
template <typename Link, typename Info>
Link* linkOf(const Info* info, VkStructureType type, VkLayerFunction function)
{
	for (auto* entry = static_cast<const VkBaseInStructure*>(info->pNext); entry; entry = entry->pNext)
	{
		auto* link = reinterpret_cast<Link*>(const_cast<VkBaseInStructure*>(entry));
		if (entry->sType == type && link->function == function)
			return link;
	}
	return nullptr;
}

template <typename Function, typename Get, typename Handle>
Function either(Get get, Handle handle, const char* name)
{
	if (const auto found = get(handle, name))
		return reinterpret_cast<Function>(found);
	return reinterpret_cast<Function>(get(handle, (std::string(name) + "KHR").c_str()));
}

std::unique_ptr<Device> makeDevice(VkDevice handle, VkPhysicalDevice physical, Instance& instance, const VkDeviceCreateInfo& info)
{
	auto device = std::make_unique<Device>();
	device->handle = handle;
	device->physical = physical;
	device->instance = &instance;
	instance.next.GetPhysicalDeviceMemoryProperties(physical, &device->memory);
	for (uint32_t i = 0; i < info.enabledExtensionCount; ++i)
		device->active = device->active || std::strcmp(info.ppEnabledExtensionNames[i], VK_NV_CLUSTER_ACCELERATION_STRUCTURE_EXTENSION_NAME) == 0;
	const auto* features = findInChain<const VkPhysicalDeviceClusterAccelerationStructureFeaturesNV>(
		info.pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_FEATURES_NV);
	device->feature_on = features && features->clusterAccelerationStructure;
	if (const auto* callback = linkOf<VkLayerDeviceCreateInfo>(&info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO, VK_LOADER_DATA_CALLBACK))
		device->set_loader_data = callback->u.pfnSetDeviceLoaderData;
	return device;
}

VkResult createNext(PFN_vkCreateDevice create, VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* allocator,
					VkDevice* device)
{
	std::vector<const char*> extensions;
	for (uint32_t i = 0; i < info->enabledExtensionCount; ++i)
		if (std::strcmp(info->ppEnabledExtensionNames[i], VK_NV_CLUSTER_ACCELERATION_STRUCTURE_EXTENSION_NAME) != 0)
			extensions.push_back(info->ppEnabledExtensionNames[i]);
	const TakenOut features(info, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CLUSTER_ACCELERATION_STRUCTURE_FEATURES_NV);
	VkDeviceCreateInfo without = *info;
	without.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
	without.ppEnabledExtensionNames = extensions.data();
	return create(physical, &without, allocator, device);
}

}  // namespace

DeviceFunctions deviceFunctions(VkDevice device, PFN_vkGetDeviceProcAddr get)
{
	DeviceFunctions functions;
	functions.get = get;
#define LAYER_FUNCTION(name) functions.name = either<PFN_vk##name>(get, device, "vk" #name);
	LAYER_DEVICE_FUNCTIONS(LAYER_FUNCTION)
#undef LAYER_FUNCTION
	for (size_t i = 0; i < functions.commands.size(); ++i)
		functions.commands[i] = get(device, ("vkCmd" + std::string(kCommandNames[i])).c_str());
	return functions;
}

InstanceFunctions instanceFunctions(VkInstance instance, PFN_vkGetInstanceProcAddr get)
{
	InstanceFunctions functions;
	functions.get = get;
#define LAYER_FUNCTION(name) functions.name = either<PFN_vk##name>(get, instance, "vk" #name);
	LAYER_INSTANCE_FUNCTIONS(LAYER_FUNCTION)
#undef LAYER_FUNCTION
	return functions;
}

Instance& instanceOf(const void* dispatchable)
{
	const std::shared_lock guard(objects_lock);
	return *instances.at(keyOf(dispatchable));
}

Device& deviceOf(const void* dispatchable)
{
	const std::shared_lock guard(objects_lock);
	return *devices.at(keyOf(dispatchable));
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator, VkInstance* instance)
{
	auto* link = linkOf<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO, VK_LAYER_LINK_INFO);
	if (!link)
		return VK_ERROR_INITIALIZATION_FAILED;
	const PFN_vkGetInstanceProcAddr get = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
	link->u.pLayerInfo = link->u.pLayerInfo->pNext;
	const auto create = reinterpret_cast<PFN_vkCreateInstance>(get(VK_NULL_HANDLE, "vkCreateInstance"));
	if (const VkResult result = create(info, allocator, instance); result != VK_SUCCESS)
		return result;
	auto made = std::make_unique<Instance>();
	made->handle = *instance;
	made->next = instanceFunctions(*instance, get);
	const std::unique_lock guard(objects_lock);
	instances[keyOf(*instance)] = std::move(made);
	return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroyInstance(VkInstance instance, const VkAllocationCallbacks* allocator)
{
	if (!instance)
		return;
	const void* key = keyOf(instance);
	instanceOf(instance).next.DestroyInstance(instance, allocator);
	const std::unique_lock guard(objects_lock);
	instances.erase(key);
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* allocator,
											VkDevice* device)
{
	auto* link = linkOf<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO, VK_LAYER_LINK_INFO);
	if (!link)
		return VK_ERROR_INITIALIZATION_FAILED;
	Instance& instance = instanceOf(physical);
	const PFN_vkGetInstanceProcAddr get_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
	const PFN_vkGetDeviceProcAddr get_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
	link->u.pLayerInfo = link->u.pLayerInfo->pNext;
	const auto create = reinterpret_cast<PFN_vkCreateDevice>(get_instance(instance.handle, "vkCreateDevice"));
	if (const VkResult result = createNext(create, physical, info, allocator, device); result != VK_SUCCESS)
		return result;
	std::unique_ptr<Device> made = makeDevice(*device, physical, instance, *info);
	made->next = deviceFunctions(*device, get_device);
	if (made->active && !canEmulate(instance, physical))
	{
		made->next.DestroyDevice(*device, allocator);
		return VK_ERROR_EXTENSION_NOT_PRESENT;
	}
	Device& kept = *made;
	{
		const std::unique_lock guard(objects_lock);
		devices[keyOf(*device)] = std::move(made);
	}
	if (kept.active)
		kept.lookup = std::make_unique<LookupTable>(kept);
	return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice handle, const VkAllocationCallbacks* allocator)
{
	if (!handle)
		return;
	Device& device = deviceOf(handle);
	const void* key = keyOf(handle);
	if (device.active)
	{
		device.next.DeviceWaitIdle(handle);
		device.report.write();
		device.structures.clear(device);
		device.lookup.reset();
		device.links.clear();
	}
	device.next.DestroyDevice(handle, allocator);
	const std::unique_lock guard(objects_lock);
	devices.erase(key);
}

VKAPI_ATTR void VKAPI_CALL getDeviceQueue(VkDevice handle, uint32_t family, uint32_t index, VkQueue* queue)
{
	Device& device = deviceOf(handle);
	device.next.GetDeviceQueue(handle, family, index, queue);
	const std::lock_guard guard(device.object_lock);
	device.queue_families[*queue] = family;
}

VKAPI_ATTR void VKAPI_CALL getDeviceQueue2(VkDevice handle, const VkDeviceQueueInfo2* info, VkQueue* queue)
{
	Device& device = deviceOf(handle);
	device.next.GetDeviceQueue2(handle, info, queue);
	const std::lock_guard guard(device.object_lock);
	device.queue_families[*queue] = info->queueFamilyIndex;
}

}  // namespace tessera::layer
