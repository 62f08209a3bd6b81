// Ray tracing pipelines and their shader binding tables.
#include "base/check.h"
#include "gpu/commands.h"
#include "gpu/shader_stages.h"

#include <array>
#include <cstring>

namespace tessera
{

namespace
{

// Groups in the order of the table.
enum Group : uint32_t
{
	kRaygen,
	kMiss,
	kHit,
	kGroupCount,
};

using Groups = std::array<VkRayTracingShaderGroupCreateInfoKHR, kGroupCount>;

Groups groupsOf(std::span<const VkPipelineShaderStageCreateInfo> stages)
{
	VkRayTracingShaderGroupCreateInfoKHR empty = { VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR };
	empty.type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR;
	empty.generalShader = empty.closestHitShader = empty.anyHitShader = empty.intersectionShader = VK_SHADER_UNUSED_KHR;
	Groups groups = { empty, empty, empty };
	groups[kHit].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
	for (uint32_t i = 0; i < stages.size(); ++i)
		switch (stages[i].stage)
		{
		case VK_SHADER_STAGE_RAYGEN_BIT_KHR:
			groups[kRaygen].generalShader = i;
			break;
		case VK_SHADER_STAGE_MISS_BIT_KHR:
			groups[kMiss].generalShader = i;
			break;
		case VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR:
			groups[kHit].closestHitShader = i;
			break;
		default:
			groups[kHit].anyHitShader = i;
		}
	return groups;
}

// One group per region, each at the alignment that regions need.
Result<RayTable> makeTable(Device& device, CommandRecorder& commands, VkPipeline pipeline, const std::string& name)
{
	const uint32_t handle_bytes = device.limits.shader_group_handle_bytes, alignment = device.limits.shader_group_alignment;
	const uint32_t stride = (handle_bytes + alignment - 1) / alignment * alignment;
	CHECK(handle_bytes > 0 && alignment <= 256, "shader groups of {} bytes, aligned to {}", handle_bytes, alignment);
	std::vector<std::byte> handles(size_t(handle_bytes) * kGroupCount), bytes(size_t(stride) * kGroupCount);
	VK_TRY(device.functions.ray_tracing_group_handles(device.handle, pipeline, 0, kGroupCount, handles.size(), handles.data()),
		   "reading the shader groups of {}", name);
	for (size_t group = 0; group < kGroupCount; ++group)
		std::memcpy(&bytes[group * stride], &handles[group * handle_bytes], handle_bytes);
	RayTable table;
	TRY_ASSIGN(table.buffer, uploadBuffer(device, commands, bytes, name + " table", VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR));
	const auto region = [&](Group group) {
		return VkStridedDeviceAddressRegionKHR{ table.buffer.address() + uint64_t(group) * stride, stride, stride };
	};
	table.raygen = region(kRaygen);
	table.miss = region(kMiss);
	table.hit = region(kHit);
	return table;
}

}  // namespace

Result<Pipeline> makeRayPipeline(Device& device, CommandRecorder& commands, VkPipelineLayout layout, std::span<const Shader> shaders,
								 const Constants& constants)
{
	ShaderStages stages(device, constants);
	TRY(stages.add(shaders));
	const Groups groups = groupsOf(stages.infos());
	VkRayTracingPipelineCreateInfoKHR info = { VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR };
#ifdef VK_NV_cluster_acceleration_structure
	VkRayTracingPipelineClusterAccelerationStructureCreateInfoNV clusters = {
		VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CLUSTER_ACCELERATION_STRUCTURE_CREATE_INFO_NV
	};
	// Also where this pipeline's rays meet no clusters yet: another frame's may.
	clusters.allowClusterAccelerationStructure = VK_TRUE;
	if (device.gates.cluster_acceleration_structure)
		info.pNext = &clusters;
#endif
	info.stageCount = static_cast<uint32_t>(stages.infos().size());
	info.pStages = stages.infos().data();
	info.groupCount = kGroupCount;
	info.pGroups = groups.data();
	info.maxPipelineRayRecursionDepth = 1;
	info.layout = layout;
	VkPipeline handle = VK_NULL_HANDLE;
	VK_TRY(device.functions.create_ray_tracing_pipelines(device.handle, VK_NULL_HANDLE, device.pipeline_cache, 1, &info, nullptr, &handle),
		   "creating the pipeline of {}", shaders.front().name);
	Pipeline pipeline(device, handle, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR);
	device.nameObject(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(handle), shaders.front().name);
	TRY_ASSIGN(RayTable table, makeTable(device, commands, handle, shaders.front().name));
	pipeline.setRayTable(std::move(table));
	return pipeline;
}

}  // namespace tessera
