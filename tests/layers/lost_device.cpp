// A Vulkan layer for tests: the device is lost at the submission whose number TESSERA_LOSE_AT says, from 0, and stays lost.
// Loaded by VK_INSTANCE_LAYERS=VK_LAYER_TESSERA_lost_device with VK_LAYER_PATH at this library's manifest. One instance, one device.
// Source: the Vulkan loader's interface for layers, version 2.
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace
{

PFN_vkGetInstanceProcAddr next_of_instance = nullptr;
PFN_vkGetDeviceProcAddr next_of_device = nullptr;
VkInstance the_instance = VK_NULL_HANDLE;
VkDevice the_device = VK_NULL_HANDLE;
std::atomic<unsigned long> submissions = 0;
std::atomic<bool> lost = false;

unsigned long loseAt()
{
	const char* text = std::getenv("TESSERA_LOSE_AT");
	return text ? std::strtoul(text, nullptr, 10) : std::numeric_limits<unsigned long>::max();
}

template <typename Function>
Function nextOf(const char* name)
{
	return reinterpret_cast<Function>(next_of_device(the_device, name));
}

// The loader's link to the next layer or the driver, of a create info's chain.
template <typename Link, typename Info>
Link* linkOf(const Info* info, VkStructureType type)
{
	for (auto* entry = static_cast<const VkBaseInStructure*>(info->pNext); entry; entry = entry->pNext)
	{
		auto* link = reinterpret_cast<Link*>(const_cast<VkBaseInStructure*>(entry));
		if (entry->sType == type && link->function == VK_LAYER_LINK_INFO)
			return link;
	}
	return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator, VkInstance* instance)
{
	auto* link = linkOf<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
	if (!link)
		return VK_ERROR_INITIALIZATION_FAILED;
	next_of_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
	link->u.pLayerInfo = link->u.pLayerInfo->pNext;
	const auto create = reinterpret_cast<PFN_vkCreateInstance>(next_of_instance(VK_NULL_HANDLE, "vkCreateInstance"));
	const VkResult result = create(info, allocator, instance);
	the_instance = result == VK_SUCCESS ? *instance : VK_NULL_HANDLE;
	return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* allocator,
											VkDevice* device)
{
	auto* link = linkOf<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
	if (!link)
		return VK_ERROR_INITIALIZATION_FAILED;
	next_of_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
	const PFN_vkGetInstanceProcAddr get = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
	link->u.pLayerInfo = link->u.pLayerInfo->pNext;
	const VkResult result = reinterpret_cast<PFN_vkCreateDevice>(get(the_instance, "vkCreateDevice"))(physical, info, allocator, device);
	the_device = result == VK_SUCCESS ? *device : VK_NULL_HANDLE;
	return result;
}

VKAPI_ATTR VkResult VKAPI_CALL queueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence)
{
	if (lost || submissions++ >= loseAt())
	{
		lost = true;
		return VK_ERROR_DEVICE_LOST;
	}
	return nextOf<PFN_vkQueueSubmit2>("vkQueueSubmit2")(queue, count, submits, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL waitForFences(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout)
{
	return lost ? VK_ERROR_DEVICE_LOST : nextOf<PFN_vkWaitForFences>("vkWaitForFences")(device, count, fences, all, timeout);
}

VKAPI_ATTR VkResult VKAPI_CALL deviceWaitIdle(VkDevice device)
{
	return lost ? VK_ERROR_DEVICE_LOST : nextOf<PFN_vkDeviceWaitIdle>("vkDeviceWaitIdle")(device);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name);

PFN_vkVoidFunction ours(const char* name)
{
	static constexpr auto kFunction = [](auto function) {
		return reinterpret_cast<PFN_vkVoidFunction>(function);
	};
	const struct
	{
		const char* name;
		PFN_vkVoidFunction function;
	} all[] = {
		{ "vkGetInstanceProcAddr", kFunction(getInstanceProcAddr) },
		{ "vkGetDeviceProcAddr", kFunction(getDeviceProcAddr) },
		{ "vkCreateInstance", kFunction(createInstance) },
		{ "vkCreateDevice", kFunction(createDevice) },
		{ "vkQueueSubmit2", kFunction(queueSubmit2) },
		{ "vkWaitForFences", kFunction(waitForFences) },
		{ "vkDeviceWaitIdle", kFunction(deviceWaitIdle) },
	};
	for (const auto& one : all)
		if (std::strcmp(one.name, name) == 0)
			return one.function;
	return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name)
{
	const PFN_vkVoidFunction function = ours(name);
	return function ? function : next_of_device(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name)
{
	const PFN_vkVoidFunction function = ours(name);
	return function ? function : next_of_instance ? next_of_instance(instance, name) : nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* negotiated)
{
	negotiated->loaderLayerInterfaceVersion = 2;
	negotiated->pfnGetInstanceProcAddr = getInstanceProcAddr;
	negotiated->pfnGetDeviceProcAddr = getDeviceProcAddr;
	negotiated->pfnGetPhysicalDeviceProcAddr = nullptr;
	return VK_SUCCESS;
}
