// Records a plan: one pipeline per kept pass, one barrier and one timer per step.
#pragma once
#include "frame/frame_resources.h"
#include "frame/pass_context.h"

#include <map>

namespace tessera
{

class PassRunner
{
public:
	static Result<std::unique_ptr<PassRunner>> create(Device& device, FrameResources& resources);
	~PassRunner();
	PassRunner(const PassRunner&) = delete;
	PassRunner& operator=(const PassRunner&) = delete;

	// Makes the pipelines of passes that have none yet. Features never depend on the view, so this happens once per pass.
	Status preparePipelines(const FramePlan& plan, const PlanInput& input);

	// Records every step of the plan between two timestamps each.
	Status record(const FramePlan& plan, const PlanInput& input);

	// GPU times of the last recorded plan, after it was waited for: per step in order, and from first to last.
	Status readTimes();
	const std::vector<double>& stepMs() const { return step_ms_; }
	double totalMs() const { return total_ms_; }

private:
	PassRunner(Device& device, FrameResources& resources) : device_(device), resources_(resources) {}
	Status makePipeline(const PassDesc& pass, const Constants& constants, const PlanInput& input);
	void stamp(uint32_t index);

	Device& device_;
	FrameResources& resources_;
	std::map<std::string_view, Pipeline> pipelines_;  // by first shader: passes may share one
	VkQueryPool queries_ = VK_NULL_HANDLE;
	size_t step_count_ = 0;
	std::vector<double> step_ms_;
	double total_ms_ = 0;
};

}  // namespace tessera
