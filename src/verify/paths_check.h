// Raster paths against each other: they may differ only where a pixel's centre lies on a micro-triangle's edge.
#pragma once
#include "verify/picture.h"
#include "verify/screen.h"

namespace tessera::verify
{

// How near a micro-triangle's edge, in pixels, a pixel's centre lies where two rasterisers may decide otherwise: they round positions on
// screen to this (Vulkan's subPixelPrecisionBits of 8, which every device that is known has).
inline constexpr double kPathEdgeRoom_px = 1.0 / 256;

// `expected` and `found`: of two raster paths that drew the micro-triangles `all`. Violations: pixels that see another micro-triangle although
// their centre lies farther than kPathEdgeRoom_px from every edge of the two that are seen, and their depths differ by more than such a move
// changes them. Their size: that distance, pixels.
CheckResult checkPaths(const Screen& screen, std::span<const MicroTriangle> all, const VisiblePicture& expected, const VisiblePicture& found,
					   const std::string& what);

}  // namespace tessera::verify
