#include "frame/pass_runner.h"

#include "base/check.h"
#include "gpu/spirv_constants.h"
#include "plan/conditions.h"

#include <algorithm>
#include <utility>

namespace tessera
{

namespace
{

constexpr uint32_t kMostSteps = 128;

struct StageAccess
{
	VkPipelineStageFlags2 stage;
	VkAccessFlags2 access;
};

StageAccess stageAccessOf(Access access)
{
	constexpr VkAccessFlags2 kRead = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;
	constexpr VkAccessFlags2 kWrite = VK_ACCESS_2_SHADER_WRITE_BIT;
	switch (access)
	{
	case Access::ComputeRead:
		return { VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kRead };
	case Access::ComputeWrite:
		return { VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kRead | kWrite };
	case Access::Indirect:
		return { VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT };
	case Access::MeshRead:
		return { VK_PIPELINE_STAGE_2_MESH_SHADER_BIT_EXT, kRead };
	case Access::VertexRead:
		return { VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, kRead };
	case Access::IndexRead:
		return { VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT };
	case Access::FragmentRead:
		return { VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, kRead };
	case Access::Color:
		return { VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT };
	case Access::Depth:
		return { VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
				 VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT };
	case Access::BuildRead:
		return { VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
				 VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT };
	case Access::BuildWrite:
		return { VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
				 VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR | VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR };
	case Access::RayRead:
		return { VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR, kRead | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR };
	case Access::RayWrite:
		return { VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR, kRead | kWrite };
	case Access::CopyRead:
		return { VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT };
	case Access::CopyWrite:
		return { VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT };
	}
	return {};
}

StageAccess stageAccessOf(AccessSet set)
{
	StageAccess all = {};
	for (uint32_t i = 0; i <= static_cast<uint32_t>(Access::CopyWrite); ++i)
		if (set.has(static_cast<Access>(i)))
		{
			const StageAccess one = stageAccessOf(static_cast<Access>(i));
			all.stage |= one.stage;
			all.access |= one.access;
		}
	return all;
}

void recordBarrier(VkCommandBuffer commands, const PlanStep& step)
{
	if (step.wait_for.empty())
		return;
	const StageAccess from = stageAccessOf(step.wait_for), to = stageAccessOf(step.then);
	VkMemoryBarrier2 barrier = { VK_STRUCTURE_TYPE_MEMORY_BARRIER_2 };
	barrier.srcStageMask = from.stage;
	barrier.srcAccessMask = from.access;
	barrier.dstStageMask = to.stage;
	barrier.dstAccessMask = to.access;
	VkDependencyInfo info = { VK_STRUCTURE_TYPE_DEPENDENCY_INFO };
	info.memoryBarrierCount = 1;
	info.pMemoryBarriers = &barrier;
	vkCmdPipelineBarrier2(commands, &info);
}

// Rows of 16 threads of the shaders that take a tile of 16 x 16 at a time: on a processor, where a workgroup's threads take turns at every
// barrier, one; else `most`.
uint32_t tileRows(const Device& device, uint32_t most)
{
	if (device.limits.compute_workgroup_threads > 0)
		return std::clamp(device.limits.compute_workgroup_threads / 16, 1u, 16u);
	return device.is_cpu ? 1 : most;
}

// Threads per workgroup of the shaders that take it as constant 0; rows of those that take tiles.
uint32_t workgroupThreads(const Device& device, const PassDesc& pass)
{
	const std::string_view shader = pass.shaders.front();
	if (shader.ends_with(".mesh"))
		return device.limits.mesh_workgroup_threads;
	if (shader == "shading/shade.comp")
		return tileRows(device, 8);
	if (shader == "culling/depth_pyramid.comp")
		return tileRows(device, 16);
	if (device.limits.compute_workgroup_threads > 0)
		return device.limits.compute_workgroup_threads;
	if (device.is_cpu)
		return 32;
	if (shader == "raster/raster_micro.comp" || shader == "raster/raster_small.comp")
		return 256;
	return shader == "tessellation/triangle_split.comp" ? 128 : 64;
}

// Projects micro-vertices or draws them: from here on a frame is a picture.
bool findsVisibility(const PassDesc& pass)
{
	return std::any_of(pass.uses.begin(), pass.uses.end(), [](const Use& use) {
		return writes(use.access) && (use.resource == "micro_vertices" || use.resource == "visibility_buffer" || use.resource == "visibility_depth");
	});
}

VkCullModeFlags cullMode(const PlanInput& input)
{
	return input.scene.has_double_sided || kSidesInFragments.holds(input) ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
}

}  // namespace

Result<std::unique_ptr<PassRunner>> PassRunner::create(Device& device, FrameResources& resources)
{
	std::unique_ptr<PassRunner> runner(new PassRunner(device, resources));
	VkQueryPoolCreateInfo info = { VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO };
	info.queryType = VK_QUERY_TYPE_TIMESTAMP;
	info.queryCount = kMostSteps + 1;
	VK_TRY(vkCreateQueryPool(device.handle, &info, nullptr, &runner->queries_), "creating the timers");
	return runner;
}

PassRunner::~PassRunner()
{
	vkDestroyQueryPool(device_.handle, queries_, nullptr);
}

Status PassRunner::load(std::string_view name, LoadedShaders& shaders)
{
	if (shaders.find(name) != shaders.end())
		return {};
	LoadedShader loaded;
	TRY_ASSIGN(loaded.shader, loadShader(name));
	loaded.constants = usedConstants(loaded.shader.words);
	shaders.emplace(name, std::move(loaded));
	return {};
}

Result<const Shader*> PassRunner::shader(std::string_view name)
{
	TRY(load(name, shaders_));
	return &shaders_.find(name)->second.shader;
}

Result<PassRunner::PipelineKey> PassRunner::keyOf(const PassDesc& pass, const FramePlan& plan)
{
	// Passes may share a compute shader; those of several shaders may share the first and differ in others.
	PipelineKey key = { pass.shaders.size() > 1 ? pass.name : pass.shaders.empty() ? std::string_view() : pass.shaders.front(), {} };
	for (std::string_view name : pass.shaders)
	{
		TRY(load(name, shaders_));
		const std::set<uint32_t>& used = shaders_.find(name)->second.constants;
		for (const Feature& feature : plan.features)
			if (used.count(feature.constant_id))
				key.second[feature.constant_id] = feature.on ? 1 : 0;
		if (used.count(0))
			key.second[0] = workgroupThreads(device_, pass);
	}
	return key;
}

Status PassRunner::makePipeline(const PassDesc& pass, const PipelineKey& key, const PlanInput& input)
{
	setWorkingOn(fmt::format("pipeline of pass {}", pass.name));
	std::vector<Shader> shaders;
	for (std::string_view name : pass.shaders)
		shaders.push_back(shaders_.find(name)->second.shader);
	if (shaders.empty())
	{
		pipelines_[key] = std::make_shared<const Pipeline>();
		return {};
	}
	DrawState state;
	if (shaders.front().stage == VK_SHADER_STAGE_VERTEX_BIT || shaders.front().stage == VK_SHADER_STAGE_MESH_BIT_EXT)
		state.cull = cullMode(input);
	TRY_ASSIGN(pipelines_[key], device_.pipelines->get(resources_.commands(), shaders, key.second, state));
	return {};
}

Status PassRunner::preparePipelines(const FramePlan& plan, const PlanInput& input)
{
	step_pipelines_.clear();
	for (const PlanStep& step : plan.steps)
	{
		TRY_ASSIGN(const PipelineKey key, keyOf(*step.pass, plan));
		if (!pipelines_.count(key))
			TRY(makePipeline(*step.pass, key, input));
		step_pipelines_.push_back(pipelines_.at(key).get());
	}
	return {};
}

Status PassRunner::replaceShaders(std::span<const Shader> shaders, const FramePlan& plan, const PlanInput& input)
{
	LoadedShaders shaders_before = shaders_;
	Pipelines pipelines_before;
	pipelines_before.swap(pipelines_);
	for (const Shader& shader : shaders)
		shaders_[shader.name] = { shader, usedConstants(shader.words) };
	const Status made = preparePipelines(plan, input);
	if (made)
		return {};
	shaders_.swap(shaders_before);
	pipelines_.swap(pipelines_before);
	TRY(preparePipelines(plan, input));
	return made;
}

void PassRunner::stamp(uint32_t index)
{
	if (device_.limits.timestamp_ns > 0)
		vkCmdWriteTimestamp2(resources_.commands().buffer(), VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, index);
}

Status PassRunner::record(const FramePlan& plan, const PlanInput& input, const View* draw_view)
{
	CHECK(plan.steps.size() <= kMostSteps, "{} steps", plan.steps.size());
	const VkCommandBuffer commands = resources_.commands().buffer();
	vkResetQueryPool(device_.handle, queries_, 0, kMostSteps + 1);
	const VkDescriptorSet set = resources_.bindless().set();
	for (VkPipelineBindPoint point : { VK_PIPELINE_BIND_POINT_COMPUTE, VK_PIPELINE_BIND_POINT_GRAPHICS, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR })
		if (point != VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR || resources_.rays().exists())
			vkCmdBindDescriptorSets(commands, point, resources_.bindless().layout(), 0, 1, &set, 0, nullptr);
	step_count_ = plan.steps.size();
	stamp(0);
	for (size_t i = 0; i < plan.steps.size(); ++i)
	{
		const PlanStep& step = plan.steps[i];
		setWorkingOn(fmt::format("pass {}", step.pass->name));
		if (device_.functions.begin_label)
		{
			const std::string name(step.pass->name);
			VkDebugUtilsLabelEXT label = { VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT };
			label.pLabelName = name.c_str();
			device_.functions.begin_label(commands, &label);
		}
		if (draw_view && findsVisibility(*step.pass))
			resources_.recordDrawView(*std::exchange(draw_view, nullptr));
		recordBarrier(commands, step);
		PassContext context(device_, commands, resources_, *step_pipelines_.at(i), resources_.bindless().layout(), step, input);
		step.pass->record(context);
		if (device_.functions.end_label)
			device_.functions.end_label(commands);
		stamp(static_cast<uint32_t>(i + 1));
	}
	return {};
}

Status PassRunner::readTimes()
{
	step_ms_.assign(step_count_, 0);
	total_ms_ = 0;
	if (device_.limits.timestamp_ns <= 0)
		return {};
	std::vector<uint64_t> ticks(step_count_ + 1);
	VK_TRY(vkGetQueryPoolResults(device_.handle, queries_, 0, static_cast<uint32_t>(ticks.size()), ticks.size() * sizeof(uint64_t), ticks.data(),
								 sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
		   "reading the timers");
	const double ms_per_tick = device_.limits.timestamp_ns * 1e-6;
	for (size_t i = 0; i < step_count_; ++i)
		step_ms_[i] = double(ticks[i + 1] - ticks[i]) * ms_per_tick;
	total_ms_ = double(ticks.back() - ticks.front()) * ms_per_tick;
	return {};
}

}  // namespace tessera
