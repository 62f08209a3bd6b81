// The loader's way in: which functions are the layer's. Source: the Vulkan loader's interface for layers, version 2.
#include "layer/device.h"
#include "layer/pipelines.h"

#include <string_view>
#include <unordered_map>

namespace tessera::layer
{

namespace
{

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name);

using Table = std::unordered_map<std::string_view, PFN_vkVoidFunction>;

template <typename Function>
PFN_vkVoidFunction plain(Function function)
{
	return reinterpret_cast<PFN_vkVoidFunction>(function);
}

const Table& instanceTable()
{
	static const Table kTable = {
		{ "vkGetInstanceProcAddr", plain(getInstanceProcAddr) },
		{ "vkCreateInstance", plain(createInstance) },
		{ "vkDestroyInstance", plain(destroyInstance) },
		{ "vkCreateDevice", plain(createDevice) },
		{ "vkEnumerateDeviceExtensionProperties", plain(enumerateDeviceExtensionProperties) },
		{ "vkGetPhysicalDeviceFeatures2", plain(getPhysicalDeviceFeatures2) },
		{ "vkGetPhysicalDeviceFeatures2KHR", plain(getPhysicalDeviceFeatures2) },
		{ "vkGetPhysicalDeviceProperties2", plain(getPhysicalDeviceProperties2) },
		{ "vkGetPhysicalDeviceProperties2KHR", plain(getPhysicalDeviceProperties2) },
	};
	return kTable;
}

// Of every device; passes calls on where the extension is not enabled.
const Table& deviceTable()
{
	static const Table kTable = {
		{ "vkGetDeviceProcAddr", plain(getDeviceProcAddr) },
		{ "vkDestroyDevice", plain(destroyDevice) },
		{ "vkGetDeviceQueue", plain(getDeviceQueue) },
		{ "vkGetDeviceQueue2", plain(getDeviceQueue2) },
		{ "vkCreateBuffer", plain(createBuffer) },
		{ "vkDestroyBuffer", plain(destroyBuffer) },
		{ "vkBindBufferMemory", plain(bindBufferMemory) },
		{ "vkBindBufferMemory2", plain(bindBufferMemory2) },
		{ "vkBindBufferMemory2KHR", plain(bindBufferMemory2) },
		{ "vkGetDeviceBufferMemoryRequirements", plain(getDeviceBufferMemoryRequirements) },
		{ "vkGetDeviceBufferMemoryRequirementsKHR", plain(getDeviceBufferMemoryRequirements) },
		{ "vkAllocateCommandBuffers", plain(allocateCommandBuffers) },
		{ "vkFreeCommandBuffers", plain(freeCommandBuffers) },
		{ "vkResetCommandPool", plain(resetCommandPool) },
		{ "vkDestroyCommandPool", plain(destroyCommandPool) },
		{ "vkBeginCommandBuffer", plain(beginCommandBuffer) },
		{ "vkEndCommandBuffer", plain(endCommandBuffer) },
		{ "vkResetCommandBuffer", plain(resetCommandBuffer) },
		{ "vkQueueSubmit", plain(queueSubmit) },
		{ "vkQueueSubmit2", plain(queueSubmit2) },
		{ "vkQueueSubmit2KHR", plain(queueSubmit2) },
		{ "vkDestroyAccelerationStructureKHR", plain(destroyAccelerationStructure) },
		{ "vkGetAccelerationStructureDeviceAddressKHR", plain(getAccelerationStructureDeviceAddress) },
		{ "vkCmdBuildAccelerationStructuresKHR", plain(cmdBuildAccelerationStructures) },
		{ "vkCmdBuildAccelerationStructuresIndirectKHR", plain(cmdBuildAccelerationStructuresIndirect) },
		{ "vkBuildAccelerationStructuresKHR", plain(buildAccelerationStructures) },
		{ "vkCmdCopyAccelerationStructureKHR", plain(cmdCopyAccelerationStructure) },
		{ "vkCreateShaderModule", plain(createShaderModule) },
		{ "vkDestroyShaderModule", plain(destroyShaderModule) },
		{ "vkCreateRayTracingPipelinesKHR", plain(createRayTracingPipelines) },
	};
	return kTable;
}

// What the driver below does not have at all.
const Table& extensionTable()
{
	static const Table kTable = {
		{ "vkGetClusterAccelerationStructureBuildSizesNV", plain(getClusterAccelerationStructureBuildSizes) },
		{ "vkCmdBuildClusterAccelerationStructureIndirectNV", plain(cmdBuildClusterAccelerationStructureIndirect) },
	};
	return kTable;
}

PFN_vkVoidFunction findIn(const Table& table, std::string_view name)
{
	const auto found = table.find(name);
	return found == table.end() ? nullptr : found->second;
}

PFN_vkVoidFunction ofDevices(std::string_view name)
{
	const PFN_vkVoidFunction function = findIn(deviceTable(), name);
	return function ? function : commandEntry(name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice handle, const char* name)
{
	const Device& device = deviceOf(handle);
	if (const PFN_vkVoidFunction function = findIn(extensionTable(), name))
		return device.active ? function : nullptr;
	const PFN_vkVoidFunction next = device.next.get(handle, name);
	const PFN_vkVoidFunction function = next ? ofDevices(name) : nullptr;
	return function ? function : next;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance handle, const char* name)
{
	if (const PFN_vkVoidFunction function = findIn(instanceTable(), name))
		return function;
	if (!handle)
		return nullptr;
	if (const PFN_vkVoidFunction function = findIn(extensionTable(), name))
		return function;
	if (std::string_view(name) == "vkGetDeviceProcAddr")
		return plain(getDeviceProcAddr);
	const PFN_vkVoidFunction next = instanceOf(handle).next.get(handle, name);
	const PFN_vkVoidFunction function = next ? ofDevices(name) : nullptr;
	return function ? function : next;
}

}  // namespace

}  // namespace tessera::layer

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* negotiated)
{
	if (negotiated->loaderLayerInterfaceVersion < 2)
		return VK_ERROR_INITIALIZATION_FAILED;
	negotiated->loaderLayerInterfaceVersion = 2;
	negotiated->pfnGetInstanceProcAddr = tessera::layer::getInstanceProcAddr;
	negotiated->pfnGetDeviceProcAddr = tessera::layer::getDeviceProcAddr;
	negotiated->pfnGetPhysicalDeviceProcAddr = nullptr;
	return VK_SUCCESS;
}
