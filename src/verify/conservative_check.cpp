#include "verify/conservative_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera::verify
{

namespace
{

constexpr double kEdgeMargin_px = 1.0 / 64;  // rasterisers snap vertices to 1/256 of a pixel
constexpr double kDepthRoom = 1e-4;          // relative; depth is rounded and interpolated in float

// Calls body(pixel, depth) for every pixel whose centre lies well inside the triangle.
template <typename Body>
void eachPixelInside(const std::array<ScreenPoint, 3>& p, uint32_t width, uint32_t height, const Body& body)
{
	const double area = screenArea(p);
	if (area == 0)
		return;
	const PixelBox box = pixelBox(p, width, height);
	for (uint32_t y = box.y0; y < box.y1; ++y)
		for (uint32_t x = box.x0; x < box.x1; ++x)
		{
			double depth = 0, inside_px = 1e300;
			for (uint32_t corner = 0; corner < 3; ++corner)
			{
				const ScreenPoint &from = p[(corner + 1) % 3], &to = p[(corner + 2) % 3];
				const double dx = to.x - from.x, dy = to.y - from.y;
				const double weight = (dx * (y + 0.5 - from.y) - dy * (x + 0.5 - from.x)) / area;
				inside_px = std::min(inside_px, weight * std::abs(area) / std::max(std::hypot(dx, dy), 1e-300));
				depth += weight * p[corner].depth;
			}
			if (inside_px > kEdgeMargin_px)
				body(size_t(y) * width + x, depth);
		}
}

void checkCulled(const Screen& screen, const MicroTriangle& t, const VisiblePicture& uncut, CheckResult& result)
{
	++result.sums["culled micro-triangles"];
	const std::vector<ScreenPoint> polygon = screen.clipped(t);
	for (size_t i = 2; i < polygon.size(); ++i)
	{
		const std::array<ScreenPoint, 3> fan = { polygon[0], polygon[i - 1], polygon[i] };
		if (!screen.shows(t, fan))
			continue;
		eachPixelInside(fan, screen.width(), screen.height(), [&](size_t pixel, double depth) {
			const VisiblePixel& seen = uncut.pixels[pixel];
			const bool is_it = seen.covered() && seen.identity == identityOf(t);
			if (!is_it && depth <= double(seen.depth) * (1 + kDepthRoom))
				return;
			result.violation(
				depth, { t.cluster,
						 t.triangle,
						 t.domain[0],
						 fmt::format("micro-triangle {} is culled and reaches pixel {}, {}", t.micro, pixel % screen.width(), pixel / screen.width()),
						 {} });
		});
	}
}

Identity partOf(const MicroTriangle& t)
{
	Identity part = identityOf(t);
	part.words[9] = 0;
	return part;
}

}  // namespace

bool DrawnThings::has(const MicroTriangle& t) const
{
	return std::binary_search(full_clusters.begin(), full_clusters.end(), std::array{ t.cluster.instance, t.cluster.cluster }) ||
		   std::binary_search(parts.begin(), parts.end(), partOf(t));
}

void addDrawn(const FrameDump& lists, const SceneOrder& order, DrawnThings& drawn)
{
	for (size_t i = 0; i < lists.full_clusters.size(); ++i)
	{
		const ClusterRef ref = order(lists.visible[lists.full_clusters[i]]);
		if (lists.cluster_is_drawn[i])
			drawn.full_clusters.push_back({ ref.instance, ref.cluster });
	}
	for (size_t i = 0; i < lists.parts.size(); ++i)
	{
		const DomainPiece& part = lists.parts[i];
		if (lists.part_is_drawn[i])
			drawn.parts.push_back(partOf({ order(lists.visible[part.visible_cluster]), part.triangle, 0, { part.c0, part.c1, part.c2 }, {}, {} }));
	}
}

void sortDrawn(DrawnThings& drawn)
{
	std::sort(drawn.full_clusters.begin(), drawn.full_clusters.end());
	std::sort(drawn.parts.begin(), drawn.parts.end());
}

CheckResult checkConservative(const Screen& screen, std::span<const MicroTriangle> all, const VisiblePicture& uncut, const DrawnThings& drawn,
							  const VisiblePicture& culled)
{
	CheckResult result = comparePictures(uncut, culled, "with culling");
	result.sums["micro-triangles"] += all.size();
	for (const MicroTriangle& t : all)
		if (!drawn.has(t))
			checkCulled(screen, t, uncut, result);
	return result;
}

}  // namespace tessera::verify
