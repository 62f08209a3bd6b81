#include "frame/rate_controller.h"

namespace tessera
{

void RateController::beginFrame(bool same_view)
{
	if (!same_view)
		attempt_ = {};
}

bool RateController::accept(const AttemptOutcome& outcome)
{
	if (outcome.fits)
	{
		const bool is_frame = attempt_.rounds == 1 || outcome.coarsening == attempt_.coarsening;
		attempt_.coarsening = outcome.coarsening;
		return is_frame;
	}
	if (outcome.rate_can_help && outcome.coarsening < kMostCoarsening)
	{
		attempt_.coarsening = outcome.coarsening + 1;
		return false;
	}
	attempt_.rounds *= 2;
	attempt_.coarsening = 0;
	return false;
}

}  // namespace tessera
