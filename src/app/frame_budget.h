// `tessera render --max-ms`: frames at the finest rate that keeps a GPU time.
#pragma once
#include "app/options.h"
#include "frame/renderer.h"
#include "frame/time_controller.h"

namespace tessera
{

// What became of a budget.
struct BudgetOutcome
{
	double budget_ms = 0;
	double rate_px = 0;            // of the last frame
	uint32_t settling_frames = 0;  // drawn to find the first rate, not counted below
	bool settled = false;
	uint32_t frames = 0;      // counted
	uint32_t over_tenth = 0;  // of those, that took more than the budget and a tenth
	double longest_ms = 0;
};

class FrameBudget
{
public:
	static constexpr uint32_t kMostSettlingFrames = 300;

	// `renderer`: of a raster path that is not auto and a rate above 0. Must outlive this.
	FrameBudget(Renderer& renderer, double budget_ms, double rate_px);

	// Draws the same view until the rate rests. Errors: those of Renderer::renderFrame.
	Status settle(const Camera& camera);
	// The next frame, at the rate that the frames before it say. Errors: as above.
	Result<FrameResult> drawFrame(const Camera& camera);

	const BudgetOutcome& outcome() const { return outcome_; }

private:
	Result<FrameResult> draw(const Camera& camera);

	Renderer& renderer_;
	TimeController controller_;
	BudgetOutcome outcome_;
};

// Options that a budget can be kept with: the raster path that `auto` stands for, and a rate to begin with.
RenderOptions budgetOptions(const RenderOptions& options, const BuiltScene& scene, const Device& device);

}  // namespace tessera
