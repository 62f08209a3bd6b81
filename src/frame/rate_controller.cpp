#include "frame/rate_controller.h"

#include <algorithm>
#include <cmath>

namespace tessera
{

void RateController::beginFrame(bool same_view)
{
	if (same_view && fitted_)
		return;
	attempt_ = {};
	step_ = 0;
	failed_.reset();
	fitted_.reset();
}

bool RateController::accept(const AttemptOutcome& outcome)
{
	if (outcome.clusters_overflow || (attempt_.every_factor_one && !outcome.fits))
	{
		attempt_.rounds *= 2;
		return false;
	}
	const uint32_t j = attempt_.coarsening;
	if (outcome.fits)
	{
		fitted_ = attempt_.every_factor_one ? kMostCoarsening : j;
		const uint32_t below = failed_ ? *failed_ + 1 : 0;
		if (attempt_.every_factor_one || *fitted_ <= below)
			return true;
		attempt_.coarsening = (below + *fitted_) / 2;
		return false;
	}
	failed_ = std::max(j, failed_.value_or(0));
	if (fitted_)
	{
		attempt_.coarsening = *failed_ + 1 >= *fitted_ ? *fitted_ : (*failed_ + 1 + *fitted_) / 2;
		return false;
	}
	// Counts fall about with the square of the rate; where they hardly fall, steps double, so that few attempts reach any j. A step
	// that is too long is corrected by the search afterwards.
	const double suggested = 8 * std::log2(std::max(outcome.worst_ratio, 1.0));
	step_ = std::max({ 1u, 2 * step_, static_cast<uint32_t>(std::min(suggested, double(kMostCoarsening))) });
	attempt_.every_factor_one = j + 1 >= kMostCoarsening;
	attempt_.coarsening = attempt_.every_factor_one ? kMostCoarsening : std::min(j + step_, kMostCoarsening - 1);
	return false;
}

}  // namespace tessera
