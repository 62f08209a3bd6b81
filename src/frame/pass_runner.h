// Records a plan: one pipeline per kept pass, one barrier and one timer per step.
#pragma once
#include "frame/frame_resources.h"
#include "frame/pass_context.h"
#include "gpu/pipeline_store.h"

#include <map>
#include <set>

namespace tessera
{

class PassRunner
{
public:
	static Result<std::unique_ptr<PassRunner>> create(Device& device, FrameResources& resources);
	~PassRunner();
	PassRunner(const PassRunner&) = delete;
	PassRunner& operator=(const PassRunner&) = delete;

	// Makes the pipelines that are missing for the plan's features. Those of other features stay, so going back to them costs nothing.
	Status preparePipelines(const FramePlan& plan, const PlanInput& input);

	// Draws with other shaders from now on. All pipelines in use are made of them first; when one cannot be, none is replaced.
	Status replaceShaders(std::span<const Shader> shaders, const FramePlan& plan, const PlanInput& input);
	// The shader that pipelines are made of. Errors: those of loadShader.
	Result<const Shader*> shader(std::string_view name);

	// Records every step of the plan between two timestamps each. `draw_view`: drawn from another camera than it is tessellated for; nullptr: from
	// the same.
	Status record(const FramePlan& plan, const PlanInput& input, const View* draw_view = nullptr);

	// GPU times of the last recorded plan, after it was waited for: per step in order, and from first to last.
	Status readTimes();
	const std::vector<double>& stepMs() const { return step_ms_; }
	double totalMs() const { return total_ms_; }

private:
	PassRunner(Device& device, FrameResources& resources) : device_(device), resources_(resources) {}
	// A shader and the constants that it reads.
	struct LoadedShader
	{
		Shader shader;
		std::set<uint32_t> constants;
	};
	using LoadedShaders = std::map<std::string, LoadedShader, std::less<>>;
	// Shader, or pass where there are several, and the constants that its pipeline reads.
	using PipelineKey = std::pair<std::string_view, Constants>;
	using Pipelines = std::map<PipelineKey, PipelineStore::Shared>;

	static Status load(std::string_view name, LoadedShaders& shaders);
	Result<PipelineKey> keyOf(const PassDesc& pass, const FramePlan& plan);
	Status makePipeline(const PassDesc& pass, const PipelineKey& key, const PlanInput& input);
	void stamp(uint32_t index);

	Device& device_;
	FrameResources& resources_;
	LoadedShaders shaders_;
	Pipelines pipelines_;
	std::vector<const Pipeline*> step_pipelines_;  // of the plan that was prepared last
	VkQueryPool queries_ = VK_NULL_HANDLE;
	size_t step_count_ = 0;
	std::vector<double> step_ms_;
	double total_ms_ = 0;
};

}  // namespace tessera
