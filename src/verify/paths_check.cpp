#include "verify/paths_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera::verify
{

namespace
{

constexpr double kDepthRoom = 1e-4;  // relative: depth is interpolated in float from positions that are rounded on screen

using Seen = std::map<Identity, const MicroTriangle*>;

// Depth of a micro-triangle's plane at a point of the picture, what a move by kPathEdgeRoom_px changes of it, and how far that point is from
// the triangle's nearest edge.
struct Crossing
{
	double depth = 0;
	double depth_room = 0;
	double edge_px = 1e300;
};

double distanceToSegment(double x, double y, const ScreenPoint& from, const ScreenPoint& to)
{
	const double dx = to.x - from.x, dy = to.y - from.y, length_squared = dx * dx + dy * dy;
	const double along = length_squared > 0 ? std::clamp(((x - from.x) * dx + (y - from.y) * dy) / length_squared, 0.0, 1.0) : 0;
	return std::hypot(x - from.x - along * dx, y - from.y - along * dy);
}

double planeDepth(double x, double y, const std::array<ScreenPoint, 3>& p)
{
	const double area = screenArea(p);
	double depth = 0;
	for (size_t corner = 0; corner < 3; ++corner)
	{
		const ScreenPoint &from = p[(corner + 1) % 3], &to = p[(corner + 2) % 3];
		depth += p[corner].depth * ((to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x)) / area;
	}
	return depth;
}

Crossing crossingOf(const Screen& screen, const MicroTriangle& t, double x, double y)
{
	const std::vector<ScreenPoint> polygon = screen.clipped(t);
	Crossing crossing;
	for (size_t i = 0; i < polygon.size(); ++i)
		crossing.edge_px = std::min(crossing.edge_px, distanceToSegment(x, y, polygon[i], polygon[(i + 1) % polygon.size()]));
	if (polygon.size() < 3)
		return crossing;
	const std::array<ScreenPoint, 3> corners = { polygon[0], polygon[1], polygon[2] };
	crossing.depth = planeDepth(x, y, corners);
	crossing.depth_room = std::abs(planeDepth(x + kPathEdgeRoom_px, y, corners) - crossing.depth) +
						  std::abs(planeDepth(x, y + kPathEdgeRoom_px, corners) - crossing.depth);
	return crossing;
}

// The micro-triangles that pixels disagree about.
Seen disputed(std::span<const MicroTriangle> all, const VisiblePicture& expected, const VisiblePicture& found)
{
	Seen seen;
	for (size_t i = 0; i < expected.pixels.size(); ++i)
		for (const VisiblePixel* pixel : { &expected.pixels[i], &found.pixels[i] })
			if (pixel->covered() && expected.pixels[i].identity != found.pixels[i].identity)
				seen[pixel->identity] = nullptr;
	for (const MicroTriangle& t : all)
		if (const auto at = seen.find(identityOf(t)); at != seen.end())
			at->second = &t;
	return seen;
}

// Distance of a pixel's centre from the nearest edge of what either sees there; 0 where both are at one depth, as far as rasterisers that round
// positions on screen can tell: of a surface seen at a flat angle that is not very far.
double disagreement(const Screen& screen, const Seen& seen, const VisiblePixel& a, const VisiblePixel& b, double x, double y)
{
	double edge_px = 1e300;
	std::vector<Crossing> crossings;
	for (const VisiblePixel* pixel : { &a, &b })
	{
		const auto at = seen.find(pixel->identity);
		if (!pixel->covered() || at == seen.end() || !at->second)
			continue;
		const Crossing crossing = crossingOf(screen, *at->second, x, y);
		edge_px = std::min(edge_px, crossing.edge_px);
		crossings.push_back(crossing);
	}
	if (crossings.size() < 2)
		return edge_px;
	const Crossing &first = crossings[0], &second = crossings[1];
	const double room = kDepthRoom * std::max(first.depth, second.depth) + first.depth_room + second.depth_room;
	return std::abs(first.depth - second.depth) <= room ? 0 : edge_px;
}

}  // namespace

CheckResult checkPaths(const Screen& screen, std::span<const MicroTriangle> all, const VisiblePicture& expected, const VisiblePicture& found,
					   const std::string& what)
{
	CheckResult result;
	result.sums["pixels compared"] = expected.pixels.size();
	if (expected.pixels.size() != found.pixels.size())
	{
		result.violation(1, nowhere(fmt::format("{}: {} pixels, not {}", what, found.pixels.size(), expected.pixels.size())));
		return result;
	}
	const Seen seen = disputed(all, expected, found);
	for (size_t i = 0; i < expected.pixels.size(); ++i)
	{
		const VisiblePixel &a = expected.pixels[i], &b = found.pixels[i];
		if (a.covered() == b.covered() && (!a.covered() || a.identity == b.identity))
			continue;
		++result.sums["pixels that differ"];
		const auto x = uint32_t(i % expected.width_px), y = uint32_t(i / expected.width_px);
		const double edge_px = disagreement(screen, seen, a, b, x + 0.5, y + 0.5);
		result.measure("farthest from an edge, px", std::min(edge_px, 1e9));
		if (edge_px <= kPathEdgeRoom_px)
			continue;
		const VisiblePixel& nearer = a.depth > b.depth ? a : b;
		Place place = { nearer.identity.cluster(), nearer.identity.triangle(), { nearer.identity.words[3], nearer.identity.words[4] } };
		place.what = fmt::format("{}: pixel {}, {} sees {}, not {}; its centre is {:.3g} px from an edge", what, x, y,
								 b.covered() ? describe(b.identity) : "nothing", a.covered() ? describe(a.identity) : "nothing", edge_px);
		place.pixel = static_cast<uint32_t>(i);
		result.violation(edge_px, place);
	}
	return result;
}

}  // namespace tessera::verify
