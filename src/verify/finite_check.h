// Is every displaced position a number, and the right one?
#pragma once
#include "verify/screen.h"

namespace tessera::verify
{

// Every micro-vertex against the surface in double precision (reference/double_surface.h); of more than `most` distinct ones an even
// sample is compared, all are tested for NaN and infinity. Violations: not finite, or a component farther off than the derived bound; their size is
// the error in mesh units. Measured: the largest error in units in the last place of the point's largest coordinate, in pixels, and over its bound.
// On all threads.
CheckResult checkFinite(const reference::HostScene& scene, const View& view, const Screen& screen, std::span<const MicroTriangle> set,
						uint64_t most = 400'000);

}  // namespace tessera::verify
