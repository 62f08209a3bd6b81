// Shader modules and ray tracing pipelines on their way to the driver.
#pragma once
#include <vulkan/vulkan.h>

namespace tessera::layer
{

VKAPI_ATTR VkResult VKAPI_CALL createShaderModule(VkDevice device, const VkShaderModuleCreateInfo* info, const VkAllocationCallbacks* allocator,
												  VkShaderModule* shader);
VKAPI_ATTR void VKAPI_CALL destroyShaderModule(VkDevice device, VkShaderModule shader, const VkAllocationCallbacks* allocator);
VKAPI_ATTR VkResult VKAPI_CALL createRayTracingPipelines(VkDevice device, VkDeferredOperationKHR deferred, VkPipelineCache cache, uint32_t count,
														 const VkRayTracingPipelineCreateInfoKHR* infos, const VkAllocationCallbacks* allocator,
														 VkPipeline* pipelines);

}  // namespace tessera::layer
