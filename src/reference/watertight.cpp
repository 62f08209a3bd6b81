#include "reference/watertight.h"

#include "reference/edge_sides.h"
#include "reference/evaluate.h"

#include <fmt/format.h>

namespace tessera::reference
{

namespace
{

struct Sides
{
	std::vector<Side> sides;
	uint64_t invalid_parts = 0;
	DomainMesh mesh;
};

void addGroup(const HostScene& scene, const View& view, std::span<const ReferencePiece> group, Sides& result)
{
	if (!isValid(scene, group[0]))
	{
		result.invalid_parts += group.size();
		return;
	}
	const ClusterRef ref = group[0].cluster;
	const BaseTriangle base = scene.base(ref, group[0].piece.triangle);
	const uint32_t flags = triangleEdgeFlags(base.flags);
	const Placement placement = scene.placement(ref, view);
	std::array<Side, 3> sides = emptySides(scene, ref, group[0].piece.triangle);
	for (const ReferencePiece& part : group)
	{
		if (!isValid(scene, part))
		{
			++result.invalid_parts;
			continue;
		}
		evaluateDomain(scene, part, result.mesh);
		for (const DomainPoint p : result.mesh.points)
			for (uint32_t edge = 0; edge < 3; ++edge)
				if (isOnEdge(p, edge))
					sides[edge].points.push_back(
						{ alongFromLow(p, edge, (flags >> edge & 1) != 0), surfacePoint(scene.surface(), base, p, placement, view).displaced });
	}
	for (Side& side : sides)
	{
		std::sort(side.points.begin(), side.points.end(), [](const EdgePoint& a, const EdgePoint& b) { return a.along < b.along; });
		side.points.erase(std::unique(side.points.begin(), side.points.end(), sameBits), side.points.end());
		result.sides.push_back(std::move(side));
	}
}

void addFullCluster(const HostScene& scene, const View& view, ClusterRef ref, Sides& result)
{
	const Evaluated cluster = evaluateFullCluster(scene, view, ref);
	for (uint32_t t = 0; t < cluster.triangles.size(); ++t)
	{
		const uint32_t flags = triangleEdgeFlags(scene.base(ref, t).flags);
		std::array<Side, 3> sides = emptySides(scene, ref, t);
		for (uint32_t edge = 0; edge < 3; ++edge)
		{
			const vec3 first = cluster.vertices[cluster.triangles[t][int(edge)]].displaced;
			const vec3 second = cluster.vertices[cluster.triangles[t][int((edge + 1) % 3)]].displaced;
			const bool from_first = (flags >> edge & 1) != 0;
			sides[edge].points = { { 0, from_first ? first : second }, { DOMAIN_SIZE, from_first ? second : first } };
			result.sides.push_back(std::move(sides[edge]));
		}
	}
}

bool isFinite(vec3 p)
{
	return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::string describe(const Side& side)
{
	return fmt::format("instance {} cluster {} triangle {} edge {}", side.cluster.instance, side.cluster.cluster, side.triangle, side.edge);
}

std::string describeDifference(const Side& a, const Side& b)
{
	std::string text = fmt::format("{} has {} points, {} has {}", describe(a), a.points.size(), describe(b), b.points.size());
	for (size_t i = 0; i < std::min(a.points.size(), b.points.size()); ++i)
		if (!sameBits(a.points[i], b.points[i]))
		{
			const EdgePoint &p = a.points[i], &q = b.points[i];
			return text + fmt::format("; point {}: {} at ({}, {}, {}) against {} at ({}, {}, {})", i, p.along, p.displaced.x, p.displaced.y,
									  p.displaced.z, q.along, q.displaced.x, q.displaced.y, q.displaced.z);
		}
	return text;
}

void compareSides(std::span<const Side* const> sides, WatertightReport& report)
{
	++(sides.size() > 1 ? report.shared_edges : report.open_edges);
	for (const Side* side : sides)
	{
		for (const EdgePoint& point : side->points)
			if (!isFinite(point.displaced) && report.not_finite++ == 0 && report.first_problem.empty())
				report.first_problem = fmt::format("{}: the position at {} is not finite", describe(*side), point.along);
		if (side == sides[0])
			continue;
		report.points += side->points.size();
		if (std::equal(side->points.begin(), side->points.end(), sides[0]->points.begin(), sides[0]->points.end(), sameBits))
			continue;
		++report.differing_edges;
		if (report.first_problem.empty())
			report.first_problem = describeDifference(*sides[0], *side);
	}
}

std::vector<Sides> collectSides(const HostScene& scene, const View& view, std::span<const ClusterRef> full_clusters,
								std::span<const ReferencePiece> parts)
{
	const auto groups = groupsOf(parts);
	return inChunks<Sides>(groups.size() + full_clusters.size(), 64, [&](Sides& chunk, size_t first, size_t end) {
		for (size_t i = first; i < end; ++i)
			if (i < groups.size())
				addGroup(scene, view, groups[i], chunk);
			else
				addFullCluster(scene, view, full_clusters[i - groups.size()], chunk);
	});
}

}  // namespace

WatertightReport checkWatertight(const HostScene& scene, const View& view, std::span<const ClusterRef> full_clusters,
								 std::span<const ReferencePiece> parts)
{
	const std::vector<Sides> chunks = collectSides(scene, view, full_clusters, parts);
	WatertightReport report;
	std::vector<const Side*> sides;
	for (const Sides& chunk : chunks)
	{
		report.invalid_parts += chunk.invalid_parts;
		for (const Side& side : chunk.sides)
			sides.push_back(&side);
	}
	if (report.invalid_parts > 0)
		report.first_problem = fmt::format("{} parts name something that does not exist", report.invalid_parts);
	std::stable_sort(sides.begin(), sides.end(), [](const Side* a, const Side* b) { return edgeKey(*a) < edgeKey(*b); });
	for (size_t first = 0, i = 1; i <= sides.size(); ++i)
		if (i == sides.size() || edgeKey(*sides[first]) != edgeKey(*sides[i]))
		{
			compareSides(std::span(sides).subspan(first, i - first), report);
			first = i;
		}
	return report;
}

}  // namespace tessera::reference
