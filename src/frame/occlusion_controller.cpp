#include "frame/occlusion_controller.h"

#include <algorithm>

namespace tessera
{

namespace
{

// Rasterising what was left out would have taken as long per item as the rest. Without timers an eighth has to be hidden.
bool pays(const OcclusionOutcome& outcome)
{
	if (outcome.looking_ms <= 0)
		return outcome.left_out * 8 >= outcome.items;
	const uint64_t drawn = std::max<uint64_t>(outcome.items - std::min(outcome.left_out, outcome.items), 1);
	return outcome.raster_ms * double(outcome.left_out) / double(drawn) > outcome.looking_ms;
}

}  // namespace

void OcclusionController::endFrame(const OcclusionOutcome* outcome)
{
	if (resting_ > 0)
	{
		--resting_;
		return;
	}
	if (!outcome)
		return;
	in_vain_ = pays(*outcome) ? 0 : in_vain_ + 1;
	if (in_vain_ == 0)
		next_rest_ = kShortestRest;
	if (in_vain_ < kPatience)
		return;
	in_vain_ = 0;
	resting_ = next_rest_;
	next_rest_ = std::min(2 * next_rest_, kLongestRest);
}

}  // namespace tessera
