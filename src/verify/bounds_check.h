// C3: do the bounds that culling trusts contain everything that the displaced surface reaches, and how tightly?
#pragma once
#include "verify/micro_set.h"

namespace tessera::verify
{

// `sorted`: all micro-triangles of a frame without culling. A micro-vertex outside the displaced box of its cluster or mesh is a violation,
// its size the distance in mesh units. Measured: diagonal of a cluster's box over the diagonal of what its micro-vertices span, the
// largest and the mean over the frame's clusters; flat bounds of a curved surface are a few times too large.
CheckResult checkBounds(const reference::HostScene& scene, const View& view, std::span<const MicroTriangle> sorted);

}  // namespace tessera::verify
