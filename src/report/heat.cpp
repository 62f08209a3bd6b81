#include "report/heat.h"

#include <algorithm>
#include <cmath>

namespace tessera::report
{

std::array<uint8_t, 3> heatColor(double px)
{
	// Black, violet, red, orange, pale yellow: lightness rises by about the same from stop to stop.
	constexpr double kStops[][3] = { { 8, 6, 20 },     { 62, 15, 105 },  { 140, 41, 99 },  { 209, 70, 60 },
									 { 245, 135, 35 }, { 247, 196, 65 }, { 252, 250, 190 } };
	constexpr size_t kLast = std::size(kStops) - 1;
	const double share = std::log2(std::max(px, kHeatLeastPx) / kHeatLeastPx) / std::log2(kHeatMostPx / kHeatLeastPx);
	const double place = std::clamp(share, 0.0, 1.0) * kLast;
	const size_t below = std::min(static_cast<size_t>(place), kLast - 1);
	std::array<uint8_t, 3> color;
	for (size_t channel = 0; channel < 3; ++channel)
	{
		const double from = kStops[below][channel], to = kStops[below + 1][channel];
		color[channel] = static_cast<uint8_t>(std::lround(from + (to - from) * (place - double(below))));
	}
	return color;
}

std::vector<uint8_t> heatColors(const ErrorPicture& picture)
{
	std::vector<uint8_t> rgba;
	rgba.reserve(picture.px.size() * 4);
	for (const float px : picture.px)
	{
		const std::array<uint8_t, 3> color = heatColor(double(px));
		rgba.insert(rgba.end(), { color[0], color[1], color[2], uint8_t(px < 0 ? 0 : 255) });
	}
	return rgba;
}

}  // namespace tessera::report
