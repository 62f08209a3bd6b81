#include "verify/leak_check.h"

#include <fmt/format.h>

#include <iterator>

namespace tessera::verify
{

namespace
{

// Where single-sided sheets are seen along their own plane, two of them may cover a pixel's points from both sides of a gap through which the
// background rightly shows. Rasterisers round corners to 1/256 pixel: points from half as far as that on tell such a gap from a leak.
constexpr double kRings_px[] = { 1.0 / 512, 1.0 / 256, 1.0 / 128, 1.0 / 16 };
constexpr uint32_t kSamples = 1 + 4 * std::size(kRings_px);
constexpr uint32_t kAll = (1u << kSamples) - 1;

// Sample 0 is the pixel's centre, four lie around it on the diagonals at every distance.
ScreenPoint sample(uint32_t index, uint32_t x, uint32_t y)
{
	if (index == 0)
		return { x + 0.5, y + 0.5, 0 };
	const double step = kRings_px[(index - 1) / 4];
	return { x + 0.5 + (index & 1 ? step : -step), y + 0.5 + (index & 2 ? step : -step), 0 };
}

// Side of the line from a to b on which (x, y) lies. From b to a it gives exactly the opposite.
double sideOf(const ScreenPoint& a, const ScreenPoint& b, double x, double y)
{
	const bool turned = b.x < a.x || (b.x == a.x && b.y < a.y);
	const ScreenPoint &low = turned ? b : a, &high = turned ? a : b;
	const double side = (high.x - low.x) * (y - low.y) - (high.y - low.y) * (x - low.x);
	return turned ? -side : side;
}

// Borders belong to both sides.
bool covers(const std::array<ScreenPoint, 3>& p, double x, double y)
{
	const double a = sideOf(p[0], p[1], x, y), b = sideOf(p[1], p[2], x, y), c = sideOf(p[2], p[0], x, y);
	return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

void paint(const std::array<ScreenPoint, 3>& p, uint32_t width, uint32_t height, std::vector<uint32_t>& covered)
{
	const PixelBox box = pixelBox(p, width, height);
	for (uint32_t y = box.y0; y < box.y1; ++y)
		for (uint32_t x = box.x0; x < box.x1; ++x)
		{
			uint32_t& samples = covered[size_t(y) * width + x];
			for (uint32_t i = 0; i < kSamples && samples != kAll; ++i)
				if (const ScreenPoint at = sample(i, x, y); covers(p, at.x, at.y))
					samples |= 1u << i;
		}
}

}  // namespace

Silhouette::Silhouette(const Screen& screen, std::span<const MicroTriangle> set) : width_(screen.width())
{
	std::vector<uint32_t> covered(size_t(screen.width()) * screen.height());
	for (const MicroTriangle& t : set)
	{
		std::array<ScreenPoint, 3> points;
		if (screen.project(t, points) && screen.shows(t, points))
			paint(points, screen.width(), screen.height(), covered);
	}
	within_.reserve(covered.size());
	for (const uint32_t samples : covered)
		within_.push_back(samples == kAll);
}

CheckResult Silhouette::leaks(const VisiblePicture& picture) const
{
	CheckResult result;
	for (size_t i = 0; i < within_.size() && i < picture.pixels.size(); ++i)
	{
		if (!within_[i])
			continue;
		++result.sums["pixels within the silhouette"];
		if (!picture.pixels[i].covered())
			result.violation(
				1, nowhere(fmt::format("pixel {}, {} shows the background through the surface", i % width_, i / width_), static_cast<uint32_t>(i)));
	}
	return result;
}

}  // namespace tessera::verify
