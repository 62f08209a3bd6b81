// The Vulkan API as this project uses it: core functions linked, extension functions in a small table of our own.
#pragma once
#include "base/result.h"

#include <vulkan/vulkan.h>

namespace tessera
{

std::string_view vulkanResultName(VkResult result);

// The exit code that a failed call leads to: device lost 7, out of memory and bad input 3, else 4.
ExitCode exitCodeOf(VkResult result);

// The one line that a failed call becomes; a lost device names the pass that was recorded or waited for.
Error vulkanError(VkResult result, const std::string& what);

struct ExtensionFunctions
{
	PFN_vkCmdDrawMeshTasksIndirectEXT draw_mesh_tasks_indirect = nullptr;
	PFN_vkCreateAccelerationStructureKHR create_acceleration_structure = nullptr;
	PFN_vkDestroyAccelerationStructureKHR destroy_acceleration_structure = nullptr;
	PFN_vkGetAccelerationStructureBuildSizesKHR acceleration_structure_sizes = nullptr;
	PFN_vkGetAccelerationStructureDeviceAddressKHR acceleration_structure_address = nullptr;
	PFN_vkCmdBuildAccelerationStructuresKHR build_acceleration_structures = nullptr;
	PFN_vkCmdCopyAccelerationStructureKHR copy_acceleration_structure = nullptr;
	PFN_vkCmdWriteAccelerationStructuresPropertiesKHR write_structure_properties = nullptr;
	PFN_vkCreateRayTracingPipelinesKHR create_ray_tracing_pipelines = nullptr;
	PFN_vkGetRayTracingShaderGroupHandlesKHR ray_tracing_group_handles = nullptr;
	PFN_vkCmdTraceRaysKHR trace_rays = nullptr;
#ifdef VK_NV_cluster_acceleration_structure
	PFN_vkGetClusterAccelerationStructureBuildSizesNV cluster_structure_sizes = nullptr;
	PFN_vkCmdBuildClusterAccelerationStructureIndirectNV build_cluster_structures = nullptr;
#endif
	PFN_vkGetPipelineExecutablePropertiesKHR executable_properties = nullptr;
	PFN_vkGetPipelineExecutableStatisticsKHR executable_statistics = nullptr;
	PFN_vkSetDebugUtilsObjectNameEXT set_object_name = nullptr;
	PFN_vkCmdBeginDebugUtilsLabelEXT begin_label = nullptr;
	PFN_vkCmdEndDebugUtilsLabelEXT end_label = nullptr;
};

}  // namespace tessera

// VK_TRY(call, "creating X {}", name): returns the Error from the calling function when the call fails.
#define VK_TRY(call, ...)                                                                        \
	do                                                                                           \
	{                                                                                            \
		const VkResult vk_result_ = (call);                                                      \
		if (vk_result_ < 0)                                                                      \
			return tl::unexpected(::tessera::vulkanError(vk_result_, fmt::format(__VA_ARGS__))); \
	} while (false)
