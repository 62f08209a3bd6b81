// C1: do the triangles on both sides of every shared edge have the same micro-vertices, to the bit?
#pragma once
#include "verify/micro_set.h"

namespace tessera::verify
{

// `sorted`: all micro-triangles of a frame without culling. Checked, each counted as a violation of its own:
//   - along every edge of the input, by welded vertices, all sides have the same points (place and bits of the position);
//   - a domain point of a base triangle has one position, whichever of its micro-triangles says it;
//   - where the input is closed and manifold: the vector area of the output is zero within rounding, so its volume is the same about every
//     origin, and the Euler characteristic is that of the input.
// The last is left out unless `as_a_whole`. Sizes of violations are gaps in mesh units. On all threads; n log n.
CheckResult checkWatertight(const reference::HostScene& scene, std::span<const MicroTriangle> sorted, bool as_a_whole = true);

}  // namespace tessera::verify
