#include "layers/cluster_tracer.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>

namespace tessera::test
{

namespace
{

constexpr uint32_t kPushBytes = 12;

struct PushConstants
{
	VkDeviceAddress hits;
	float extent;
};

std::vector<uint32_t> shaderWords(const std::string& name)
{
	std::ifstream file(std::string(TESSERA_LAYER_SHADERS) + "/" + name + ".spv", std::ios::binary | std::ios::ate);
	std::vector<uint32_t> words(file ? size_t(file.tellg()) / 4 : 0);
	file.seekg(0);
	file.read(reinterpret_cast<char*>(words.data()), std::streamsize(words.size() * 4));
	EXPECT_FALSE(words.empty()) << name;
	return words;
}

// The same module without the capability to read a cluster's id.
std::vector<uint32_t> withoutCapability(const std::vector<uint32_t>& words)
{
	constexpr uint32_t kCapability = 2u << 16 | 17u, kCluster = 5437;
	std::vector<uint32_t> out(words.begin(), words.begin() + 5);
	for (size_t at = 5; at < words.size(); at += words[at] >> 16)
		if (words[at] != kCapability || words[at + 1] != kCluster)
			out.insert(out.end(), words.begin() + std::ptrdiff_t(at), words.begin() + std::ptrdiff_t(at + (words[at] >> 16)));
	return out;
}

VkShaderModule makeModule(Gpu& gpu, const std::vector<uint32_t>& words)
{
	const VkShaderModuleCreateInfo info = { VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, words.size() * 4, words.data() };
	VkShaderModule module = VK_NULL_HANDLE;
	EXPECT_VK(vkCreateShaderModule(gpu.device, &info, nullptr, &module));
	return module;
}

// A scene in a descriptor set, and the layout of pipelines that use it.
class SceneSet
{
public:
	SceneSet(Gpu& gpu, const Structure& scene, VkShaderStageFlags stage) : gpu_(gpu), stage_(stage)
	{
		const VkDescriptorSetLayoutBinding binding = { 0, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1, stage, nullptr };
		const VkDescriptorSetLayoutCreateInfo sets = { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0, 1, &binding };
		EXPECT_VK(vkCreateDescriptorSetLayout(gpu.device, &sets, nullptr, &set_layout_));
		const VkPushConstantRange push = { stage, 0, kPushBytes };
		const VkPipelineLayoutCreateInfo info = { VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, &set_layout_, 1, &push };
		EXPECT_VK(vkCreatePipelineLayout(gpu.device, &info, nullptr, &layout));
		const VkDescriptorPoolSize size = { VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1 };
		const VkDescriptorPoolCreateInfo pool = { VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, 1, &size };
		EXPECT_VK(vkCreateDescriptorPool(gpu.device, &pool, nullptr, &pool_));
		const VkDescriptorSetAllocateInfo allocation = { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool_, 1, &set_layout_ };
		EXPECT_VK(vkAllocateDescriptorSets(gpu.device, &allocation, &set_));
		const VkWriteDescriptorSetAccelerationStructureKHR structure = { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR, nullptr,
																		 1, &scene.handle };
		const VkWriteDescriptorSet write = { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,       &structure, set_, 0, 0, 1,
											 VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR };
		vkUpdateDescriptorSets(gpu.device, 1, &write, 0, nullptr);
	}
	~SceneSet()
	{
		vkDestroyPipelineLayout(gpu_.device, layout, nullptr);
		vkDestroyDescriptorPool(gpu_.device, pool_, nullptr);
		vkDestroyDescriptorSetLayout(gpu_.device, set_layout_, nullptr);
	}
	SceneSet(const SceneSet&) = delete;
	SceneSet& operator=(const SceneSet&) = delete;

	void bind(VkCommandBuffer commands, VkPipelineBindPoint point, VkPipeline pipeline, const PushConstants& args) const
	{
		vkCmdBindPipeline(commands, point, pipeline);
		vkCmdBindDescriptorSets(commands, point, layout, 0, 1, &set_, 0, nullptr);
		vkCmdPushConstants(commands, layout, stage_, 0, kPushBytes, &args);
	}

	VkPipelineLayout layout = VK_NULL_HANDLE;

private:
	Gpu& gpu_;
	VkShaderStageFlags stage_;
	VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
	VkDescriptorPool pool_ = VK_NULL_HANDLE;
	VkDescriptorSet set_ = VK_NULL_HANDLE;
};

VkPipeline makeRayPipeline(Gpu& gpu, VkPipelineLayout layout, const std::array<const char*, 3>& shaders, const TraceOptions& options)
{
	constexpr VkShaderStageFlagBits kStages[] = { VK_SHADER_STAGE_RAYGEN_BIT_KHR, VK_SHADER_STAGE_MISS_BIT_KHR, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR };
	std::array<VkPipelineShaderStageCreateInfo, 3> stages = {};
	std::array<VkRayTracingShaderGroupCreateInfoKHR, 3> groups = {};
	for (uint32_t i = 0; i < 3; ++i)
	{
		const std::vector<uint32_t> words = shaderWords(shaders[i]);
		const VkShaderModule module = makeModule(gpu, options.say_capability ? words : withoutCapability(words));
		stages[i] = { VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, kStages[i], module, "main", nullptr };
		groups[i] = { VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
					  nullptr,
					  i < 2 ? VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR : VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR,
					  i < 2 ? i : VK_SHADER_UNUSED_KHR,
					  i < 2 ? VK_SHADER_UNUSED_KHR : i,
					  VK_SHADER_UNUSED_KHR,
					  VK_SHADER_UNUSED_KHR };
	}
	VkRayTracingPipelineClusterAccelerationStructureCreateInfoNV clusters = {
		VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CLUSTER_ACCELERATION_STRUCTURE_CREATE_INFO_NV, nullptr, options.allow_clusters
	};
	VkRayTracingPipelineCreateInfoKHR info = { VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR, &clusters };
	info.stageCount = info.groupCount = 3;
	info.pStages = stages.data();
	info.pGroups = groups.data();
	info.maxPipelineRayRecursionDepth = 1;
	info.layout = layout;
	VkPipeline pipeline = VK_NULL_HANDLE;
	EXPECT_VK(gpu.CreateRayTracingPipelinesKHR(gpu.device, VK_NULL_HANDLE, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
	for (const auto& stage : stages)
		vkDestroyShaderModule(gpu.device, stage.module, nullptr);
	return pipeline;
}

// The three groups of a pipeline, in a buffer.
struct ShaderTable
{
	ShaderTable(Gpu& gpu, VkPipeline pipeline) : buffer(gpu, 4 * kStride)
	{
		const uint32_t handle = gpu.ray_properties.shaderGroupHandleSize;
		std::vector<std::byte> handles(size_t(3) * handle);
		EXPECT_VK(gpu.GetRayTracingShaderGroupHandlesKHR(gpu.device, pipeline, 0, 3, handles.size(), handles.data()));
		const VkDeviceSize start = (kStride - buffer.address % kStride) % kStride;
		for (uint32_t i = 0; i < 3; ++i)
		{
			std::memcpy(buffer.data + start + i * kStride, handles.data() + size_t(i) * handle, handle);
			regions[i] = { buffer.address + start + i * kStride, kStride, kStride };
		}
	}
	static constexpr VkDeviceSize kStride = 64;  // the most that a device may ask for
	Buffer buffer;
	std::array<VkStridedDeviceAddressRegionKHR, 3> regions = {};
};

}  // namespace

std::vector<Hit> trace(Gpu& gpu, const Structure& scene, const char* closest_hit, float extent, uint32_t side, const TraceOptions& options)
{
	const SceneSet set(gpu, scene, VK_SHADER_STAGE_RAYGEN_BIT_KHR);
	const VkPipeline pipeline = makeRayPipeline(gpu, set.layout, { "trace.rgen", "trace.rmiss", closest_hit }, options);
	const ShaderTable table(gpu, pipeline);
	const Buffer hits(gpu, size_t(side) * side * sizeof(Hit));
	gpu.run([&](VkCommandBuffer commands) {
		set.bind(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline, { hits.address, extent });
		if (options.between)
			options.between(commands);
		const VkStridedDeviceAddressRegionKHR none = {};
		gpu.CmdTraceRaysKHR(commands, &table.regions[0], &table.regions[1], &table.regions[2], &none, side, side, 1);
	});
	vkDestroyPipeline(gpu.device, pipeline, nullptr);
	return hits.read<Hit>(size_t(side) * side);
}

std::vector<Hit> traceByQueries(Gpu& gpu, const Structure& scene, float extent, uint32_t side)
{
	const SceneSet set(gpu, scene, VK_SHADER_STAGE_COMPUTE_BIT);
	const VkShaderModule module = makeModule(gpu, shaderWords("query.comp"));
	VkComputePipelineCreateInfo info = { VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO };
	info.stage = { VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, VK_SHADER_STAGE_COMPUTE_BIT, module, "main", nullptr };
	info.layout = set.layout;
	VkPipeline pipeline = VK_NULL_HANDLE;
	EXPECT_VK(vkCreateComputePipelines(gpu.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
	vkDestroyShaderModule(gpu.device, module, nullptr);
	const Buffer hits(gpu, size_t(side) * side * sizeof(Hit));
	gpu.run([&](VkCommandBuffer commands) {
		set.bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, { hits.address, extent });
		vkCmdDispatch(commands, side, side, 1);
	});
	vkDestroyPipeline(gpu.device, pipeline, nullptr);
	return hits.read<Hit>(size_t(side) * side);
}

}  // namespace tessera::test
