// The candidates that rate_search chooses from: rates x 2^(j/16) with what follows from them (DESIGN.md, contract C2). Pure.
#pragma once
#include "frame/rate_controller.h"
#include "scene/camera.h"
#include "tessellation/rate_search.h"

#include <vector>

namespace tessera
{

// rate x 2^(j/16), pixels.
double coarsenedRate(double rate_px, uint32_t j);

// Candidates j = first, first + 1 ... up to the first at which no edge can get two segments, or kMostCoarsening; at the last every factor
// is 1. `request`: as of `view`, which is made for the asked rate coarsened by `first`. `largest_factor`: no edge has a larger factor in
// `view` (FactorBound). `table_size` and `max_split`: of the table and the options. At least two, the counts in them 0.
std::vector<RateStep> rateSteps(const Camera& camera, const View& view, const ViewRequest& request, uint32_t first, double largest_factor,
								uint32_t table_size, uint32_t max_split);

}  // namespace tessera
