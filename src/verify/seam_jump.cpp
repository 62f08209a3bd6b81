#include "verify/seam_jump.h"

#include "reference/piece_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera::verify
{

namespace
{

// True when the triangle reads another one's height there.
bool isForeign(const reference::HostScene& scene, const BaseTriangle& base, DomainPoint p)
{
	const bool zero[3] = { p.u == 0, p.v == 0, domainW(p) == 0 };
	if (!zero[0] && !zero[1] && !zero[2])
		return false;
	const uint32_t vertices[3] = { base.v0, base.v1, base.v2 };
	const auto& corners = scene.built().seam_corner_indices;
	for (uint32_t corner = 0; corner < 3; ++corner)
		if (zero[(corner + 1) % 3] && zero[(corner + 2) % 3])
			return !corners.empty() && corners[vertices[corner]] != NO_INDEX;
	for (uint32_t edge = 0; edge < 3; ++edge)
		if (reference::isOnEdge(p, edge))
			return (triangleSeamFlags(base.flags) >> edge & 1) != 0;
	return false;
}

double displacementOf(const reference::HostScene& scene, const View& view, const HeightSource& source, vec3 base_point, const Placement& placement)
{
	return double(displacementAt(scene.surface(), source, base_point, placement, view));
}

// Difference between the height that is used at a point and the one that the triangle would read itself, mesh units.
double jumpAt(const reference::HostScene& scene, const View& view, const BaseTriangle& base, const Placement& placement, DomainPoint p)
{
	const TriangleCorners corners = triangleCorners(scene.surface(), base);
	const SurfaceSample at = sampleAtPoint(scene.surface(), base, p);
	const double used = displacementOf(scene, view, at.source, at.base, placement);
	const double own = displacementOf(scene, view, ownHeightSource(corners, base.height_map, domainWeights(p)), at.base, placement);
	return std::abs(used - own);
}

double shortestEdge(const MicroTriangle& t, uint32_t corner)
{
	const dvec3 p(t.displaced[corner]);
	return std::min(glm::length(dvec3(t.displaced[(corner + 1) % 3]) - p), glm::length(dvec3(t.displaced[(corner + 2) % 3]) - p));
}

}  // namespace

void SeamJump::merge(const SeamJump& other)
{
	if (other.largest_mesh > largest_mesh)
		place = other.place;
	points += other.points;
	sum_mesh += other.sum_mesh;
	largest_mesh = std::max(largest_mesh, other.largest_mesh);
	largest_px = std::max(largest_px, other.largest_px);
	largest_over_row = std::max(largest_over_row, other.largest_over_row);
}

SeamJump measureSeams(const reference::HostScene& scene, const View& view, const Screen& screen, std::span<const MicroTriangle> sorted)
{
	SeamJump seams;
	const SceneTraits& traits = scene.built().traits;
	if (!traits.has_displacement || traits.seam_edges + traits.seam_corners == 0)
		return seams;
	for (const MicroTriangle& t : sorted)
	{
		const BaseTriangle base = scene.base(t.cluster, t.triangle);
		for (uint32_t i = 0; i < 3; ++i)
		{
			const DomainPoint p = t.domain[i];
			if (p.u == NO_INDEX || !isForeign(scene, base, p))
				continue;
			const double jump = jumpAt(scene, view, base, scene.placement(t.cluster, view), p);
			const double scale = glm::length(dvec3(scene.built().instances[t.cluster.instance].world[0]));
			++seams.points;
			seams.sum_mesh += jump;
			seams.largest_px = std::max(seams.largest_px, jump * scale * screen.pixelsPerUnit(t.cluster.instance, t.displaced[i]));
			const double row = shortestEdge(t, i);
			seams.largest_over_row = std::max(seams.largest_over_row, row > 0 ? jump / row : 0);
			if (jump > seams.largest_mesh)
			{
				seams.largest_mesh = jump;
				seams.place = { t.cluster, t.triangle, p, fmt::format("the seam's owner is {:.4g} mesh units away", jump), {} };
			}
		}
	}
	return seams;
}

}  // namespace tessera::verify
