#include "layer/pipelines.h"

#include "layer/chain.h"
#include "layer/device.h"
#include "layer/spirv_rewrite.h"

#include <deque>
#include <vector>

namespace tessera::layer
{

namespace
{

constexpr VkStructureType kOptIn = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CLUSTER_ACCELERATION_STRUCTURE_CREATE_INFO_NV;

bool allowsClusters(const VkRayTracingPipelineCreateInfoKHR& info)
{
	const auto* opt_in = findInChain<const VkRayTracingPipelineClusterAccelerationStructureCreateInfoNV>(info.pNext, kOptIn);
	return opt_in && opt_in->allowClusterAccelerationStructure;
}

// A pipeline whose shaders ask for clusters must have been made for them.
void checkOptIn(Device& device, const VkRayTracingPipelineCreateInfoKHR& info)
{
	const bool allowed = allowsClusters(info);
	const std::lock_guard guard(device.object_lock);
	for (uint32_t i = 0; i < info.stageCount; ++i)
		if (!info.pStages[i].module)
			device.report.limit("limit-inline-shader",
								"vkCreateRayTracingPipelinesKHR: stage {} has no shader module, so the layer did not see its code", i);
		else if (!allowed && device.cluster_modules.contains(info.pStages[i].module))
			device.report.violation("pipeline-without-clusters",
									"vkCreateRayTracingPipelinesKHR: stage {} reads gl_ClusterIDNV, but the pipeline has no "
									"VkRayTracingPipelineClusterAccelerationStructureCreateInfoNV that allows clusters",
									i);
}

}  // namespace

VKAPI_ATTR VkResult VKAPI_CALL createShaderModule(VkDevice handle, const VkShaderModuleCreateInfo* info, const VkAllocationCallbacks* allocator,
												  VkShaderModule* shader)
{
	Device& device = deviceOf(handle);
	if (!device.active)
		return device.next.CreateShaderModule(handle, info, allocator, shader);
	const Rewritten rewritten = rewriteShader({ info->pCode, info->codeSize / sizeof(uint32_t) }, device.lookup->root());
	for (const auto& [name, problem] : rewritten.problems)
		device.report.limit(name, "vkCreateShaderModule: {}", problem);
	if (rewritten.reads_cluster_id && !rewritten.says_so)
		device.report.violation(
			"shader-capability",
			"vkCreateShaderModule: a shader reads gl_ClusterIDNV without the capability RayTracingClusterAccelerationStructureNV");
	VkShaderModuleCreateInfo changed = *info;
	if (!rewritten.words.empty())
	{
		changed.codeSize = rewritten.words.size() * sizeof(uint32_t);
		changed.pCode = rewritten.words.data();
		device.report.count("shaders rewritten", 1);
	}
	const VkResult result = device.next.CreateShaderModule(handle, &changed, allocator, shader);
	if (result == VK_SUCCESS && rewritten.reads_cluster_id)
	{
		const std::lock_guard guard(device.object_lock);
		device.cluster_modules.insert(*shader);
	}
	return result;
}

VKAPI_ATTR void VKAPI_CALL destroyShaderModule(VkDevice handle, VkShaderModule shader, const VkAllocationCallbacks* allocator)
{
	Device& device = deviceOf(handle);
	{
		const std::lock_guard guard(device.object_lock);
		device.cluster_modules.erase(shader);
	}
	device.next.DestroyShaderModule(handle, shader, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL createRayTracingPipelines(VkDevice handle, VkDeferredOperationKHR deferred, VkPipelineCache cache, uint32_t count,
														 const VkRayTracingPipelineCreateInfoKHR* infos, const VkAllocationCallbacks* allocator,
														 VkPipeline* pipelines)
{
	Device& device = deviceOf(handle);
	if (!device.active)
		return device.next.CreateRayTracingPipelinesKHR(handle, deferred, cache, count, infos, allocator, pipelines);
	for (uint32_t i = 0; i < count; ++i)
		checkOptIn(device, infos[i]);
	// The copies' chains are the program's own, so what is taken out is put back when this returns.
	std::vector<VkRayTracingPipelineCreateInfoKHR> changed(infos, infos + count);
	std::deque<TakenOut> taken;
	for (VkRayTracingPipelineCreateInfoKHR& info : changed)
		taken.emplace_back(&info, kOptIn);
	// At once: a deferred operation would find the chains as they were.
	const VkResult result = device.next.CreateRayTracingPipelinesKHR(handle, VK_NULL_HANDLE, cache, count, changed.data(), allocator, pipelines);
	taken.clear();
	const std::lock_guard guard(device.object_lock);
	for (uint32_t i = 0; i < count; ++i)
		if (pipelines[i] && !allowsClusters(infos[i]))
			device.pipelines_without_clusters.insert(pipelines[i]);
		else
			device.pipelines_without_clusters.erase(pipelines[i]);
	return deferred && result == VK_SUCCESS ? VK_OPERATION_NOT_DEFERRED_KHR : result;
}

}  // namespace tessera::layer
