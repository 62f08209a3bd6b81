// Colours for errors in pixels.
#pragma once
#include "report/geometry_error.h"

#include <array>

namespace tessera::report
{

inline constexpr double kHeatLeastPx = 1.0 / 64, kHeatMostPx = 16;  // ends of the scale, which is logarithmic

// Dark to bright in even steps of lightness; the ends stand for everything beyond them. sRGB.
std::array<uint8_t, 3> heatColor(double px);

// RGBA, transparent where nothing is seen.
std::vector<uint8_t> heatColors(const ErrorPicture& picture);

}  // namespace tessera::report
