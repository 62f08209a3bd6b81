// C1 in the picture: does the background shine through where the surface has no hole?
#pragma once
#include "verify/picture.h"
#include "verify/screen.h"

namespace tessera::verify
{

// `set`: every micro-triangle of the frame; `picture`: what its pixels see. A background pixel is a leak when micro-triangles cover its centre and
// four points 1/16 pixel from it, found in double precision with one edge function for both sides of every edge, so that no point can fall
// between two neighbours. Rasterisers may move a vertex by 1/256 pixel. Triangles that cross the near plane count as nothing.
CheckResult checkLeaks(const Screen& screen, std::span<const MicroTriangle> set, const VisiblePicture& picture);

}  // namespace tessera::verify
