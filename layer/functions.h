// The functions of the next layer or the driver.
#pragma once
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <array>
#include <string_view>

namespace tessera::layer
{

// Commands as they are recorded, without "vkCmd": their names are generated from the Vulkan header.
enum class Command
{
#define LAYER_COMMAND(name) name,
#include "recorded_commands.inc"
#undef LAYER_COMMAND
	Count,
};

inline constexpr std::string_view kCommandNames[] = {
#define LAYER_COMMAND(name) std::string_view(#name),
#include "recorded_commands.inc"
#undef LAYER_COMMAND
};

// What the layer itself calls. A function that Vulkan 1.3 took over from KHR is found under either name.
#define LAYER_DEVICE_FUNCTIONS(X)                \
	X(AllocateCommandBuffers)                    \
	X(AllocateMemory)                            \
	X(BeginCommandBuffer)                        \
	X(BindBufferMemory)                          \
	X(BindBufferMemory2)                         \
	X(CmdBindDescriptorSets)                     \
	X(CmdBindIndexBuffer)                        \
	X(CmdBindPipeline)                           \
	X(CmdBindVertexBuffers)                      \
	X(BuildAccelerationStructuresKHR)            \
	X(CmdBuildAccelerationStructuresIndirectKHR) \
	X(CmdBuildAccelerationStructuresKHR)         \
	X(CmdCopyAccelerationStructureKHR)           \
	X(CmdCopyBuffer)                             \
	X(CmdFillBuffer)                             \
	X(CmdPipelineBarrier)                        \
	X(CmdPushConstants)                          \
	X(CmdSetScissor)                             \
	X(CmdSetViewport)                            \
	X(CreateAccelerationStructureKHR)            \
	X(CreateBuffer)                              \
	X(CreateCommandPool)                         \
	X(CreateFence)                               \
	X(CreateRayTracingPipelinesKHR)              \
	X(CreateShaderModule)                        \
	X(DestroyAccelerationStructureKHR)           \
	X(DestroyBuffer)                             \
	X(DestroyCommandPool)                        \
	X(DestroyDevice)                             \
	X(DestroyFence)                              \
	X(DestroyShaderModule)                       \
	X(DeviceWaitIdle)                            \
	X(EndCommandBuffer)                          \
	X(FreeCommandBuffers)                        \
	X(FreeMemory)                                \
	X(GetAccelerationStructureBuildSizesKHR)     \
	X(GetAccelerationStructureDeviceAddressKHR)  \
	X(GetBufferDeviceAddress)                    \
	X(GetBufferMemoryRequirements)               \
	X(GetDeviceBufferMemoryRequirements)         \
	X(GetDeviceQueue)                            \
	X(GetDeviceQueue2)                           \
	X(MapMemory)                                 \
	X(QueueSubmit)                               \
	X(QueueSubmit2)                              \
	X(ResetCommandBuffer)                        \
	X(ResetCommandPool)                          \
	X(ResetFences)                               \
	X(WaitForFences)

#define LAYER_INSTANCE_FUNCTIONS(X)       \
	X(DestroyInstance)                    \
	X(EnumerateDeviceExtensionProperties) \
	X(GetPhysicalDeviceFeatures2)         \
	X(GetPhysicalDeviceFormatProperties)  \
	X(GetPhysicalDeviceMemoryProperties)  \
	X(GetPhysicalDeviceProperties2)

struct DeviceFunctions
{
#define LAYER_FUNCTION(name) PFN_vk##name name = nullptr;
	LAYER_DEVICE_FUNCTIONS(LAYER_FUNCTION)
#undef LAYER_FUNCTION
	PFN_vkGetDeviceProcAddr get = nullptr;
	std::array<PFN_vkVoidFunction, size_t(Command::Count)> commands = {};
};

struct InstanceFunctions
{
#define LAYER_FUNCTION(name) PFN_vk##name name = nullptr;
	LAYER_INSTANCE_FUNCTIONS(LAYER_FUNCTION)
#undef LAYER_FUNCTION
	PFN_vkGetInstanceProcAddr get = nullptr;
};

DeviceFunctions deviceFunctions(VkDevice device, PFN_vkGetDeviceProcAddr get);
InstanceFunctions instanceFunctions(VkInstance instance, PFN_vkGetInstanceProcAddr get);

}  // namespace tessera::layer
