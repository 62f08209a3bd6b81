#include "frame/rate_steps.h"

#include "scene/factor_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera
{

double coarsenedRate(double rate_px, uint32_t j)
{
	return rate_px * std::exp2(j / 16.0);
}

std::vector<RateStep> rateSteps(const Camera& camera, const View& view, const ViewRequest& request, uint32_t first, double largest_factor,
								uint32_t table_size, uint32_t max_split)
{
	std::vector<RateStep> steps;
	const double asked = request.rate_px * std::exp2(-(first / 16.0));
	View coarser = view;
	for (uint32_t j = first; j <= RateController::kMostCoarsening; ++j)
	{
		ViewRequest at = request;
		at.rate_px = j == first ? request.rate_px : coarsenedRate(asked, j);
		at.every_factor_one = j > first && (j == RateController::kMostCoarsening || largest_factor * std::exp2(-((j - first) / 16.0)) < 1.5);
		setRate(coarser, camera, at);
		RateStep step = {};
		step.rate_over_focal_squared = coarser.rate_over_focal_squared;
		step.sample_over_focal_squared = coarser.sample_over_focal_squared;
		step.rule = factorRule(coarser, table_size, max_split);
		steps.push_back(step);
		if (std::isinf(step.rate_over_focal_squared) && j > first)
			break;
	}
	return steps;
}

}  // namespace tessera
