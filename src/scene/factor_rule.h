// The limits of the table and of one split that a frame uses, so that splitting always ends.
#pragma once
#include "shared/edge_factor.h"

#include <algorithm>
#include <cmath>

namespace tessera
{

// table_size: the table's, or less at a very coarse rate. With s = rate / focal_px, an edge that fits the table is shorter than
// (T + 1/2) s times its distance. Below 1 times, no part of it can exceed the table (what a part gains in nearness it loses in length);
// above, an edge passing close by the eye may fit while a part of it does not, and a triangle flat enough for its corners to lie on that
// edge in domain points is cut into itself for ever (seen at s = 0.2 and factor 43). 3/4 leaves room for the rounding of
// domain points. At 1080 lines and 60 degrees the table is whole up to 61 pixels.
// Orthographic views have one distance for all, so they need none of this. `table_size` 2..11, `max_split` 2..table_size.
inline FactorRule factorRule(const View& view, uint32_t table_size, uint32_t max_split)
{
	if (view.distance_weight == 0)
		return { table_size, max_split };
	const double s = std::sqrt(double(view.rate_over_focal_squared));
	const double largest = std::floor(0.75 / s - 0.5);
	return { largest >= table_size ? table_size : static_cast<uint32_t>(std::max(largest, 1.0)), max_split };
}

}  // namespace tessera
