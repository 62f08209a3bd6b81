#include "app/frame_budget.h"

#include "plan/conditions.h"

#include <algorithm>

namespace tessera
{

FrameBudget::FrameBudget(Renderer& renderer, double budget_ms, double rate_px) : renderer_(renderer), controller_(budget_ms, rate_px)
{
	outcome_.budget_ms = budget_ms;
}

Result<FrameResult> FrameBudget::draw(const Camera& camera)
{
	outcome_.rate_px = controller_.rate();
	renderer_.setRate(static_cast<float>(controller_.rate()));
	TRY_ASSIGN(FrameResult result, renderer_.renderFrame(camera));
	controller_.endFrame(outcome_.rate_px, result.gpu_ms);
	return result;
}

Status FrameBudget::settle(const Camera& camera)
{
	while (!controller_.isSettled() && outcome_.settling_frames < kMostSettlingFrames)
	{
		TRY(draw(camera));
		++outcome_.settling_frames;
	}
	outcome_.settled = controller_.isSettled();
	return {};
}

Result<FrameResult> FrameBudget::drawFrame(const Camera& camera)
{
	TRY_ASSIGN(FrameResult result, draw(camera));
	++outcome_.frames;
	outcome_.over_tenth += result.gpu_ms > 1.1 * outcome_.budget_ms;
	outcome_.longest_ms = std::max(outcome_.longest_ms, result.gpu_ms);
	return result;
}

RenderOptions budgetOptions(const RenderOptions& options, const BuiltScene& scene, const Device& device)
{
	RenderOptions kept = options;
	if (kept.rate <= 0)
		kept.rate = RenderOptions().rate;
	kept.raster = chosenRaster({ kept, scene.traits, sizesOf(scene), traitsOf(device), {}, {} });
	return kept;
}

}  // namespace tessera
