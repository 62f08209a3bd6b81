// C2: is every base triangle covered by its micro-triangles exactly once? Decided in integers.
#pragma once
#include "verify/micro_set.h"

namespace tessera::verify
{

// A piece whose doubled area is at most this times its longest edge, in domain units, is a sliver: rounding may turn its
// micro-triangles over. Derived for the built-in table in docs/numerics.md.
constexpr double kSliver = 60;

// `sorted`: all micro-triangles of a frame without culling: every base triangle of every instance must be there. Violations: base triangles that
// are missing, whose signed areas do not add up to exactly their own, or with a micro-edge inside that has no opposite (an overlap, a
// T-junction) or a border that is not walked once; micro-triangles of no or negative area outside slivers; corners of another triangle.
// Size of a violation: the part of the base triangle that is wrong, 0..1 or more. On all threads; n log n.
CheckResult checkHoles(const reference::HostScene& scene, std::span<const MicroTriangle> sorted);

}  // namespace tessera::verify
