#include "verify/watertight_check.h"

#include "reference/edge_sides.h"
#include "verify/topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace tessera::verify
{

namespace
{

using reference::EdgePoint;
using reference::HostScene;
using reference::Side;

struct Chunk
{
	std::vector<Side> sides;
	CheckResult result;
	Topology topology;
};

// Every domain point of the base triangle with its position; one that has two is a violation.
std::vector<std::pair<DomainPoint, vec3>> pointsOf(std::span<const MicroTriangle> group, CheckResult& result)
{
	std::vector<std::pair<DomainPoint, vec3>> points;
	for (const MicroTriangle& t : group)
		for (uint32_t i = 0; i < 3; ++i)
			if (t.domain[i].u != NO_INDEX)
				points.emplace_back(t.domain[i], t.displaced[i]);
	const auto key = [](const auto& p) {
		return uint64_t(p.first.u) << 32 | p.first.v;
	};
	std::stable_sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
	for (size_t i = 1; i < points.size(); ++i)
		if (key(points[i]) == key(points[i - 1]) && std::memcmp(&points[i].second, &points[i - 1].second, sizeof(vec3)) != 0)
		{
			const double gap = glm::length(dvec3(points[i].second) - dvec3(points[i - 1].second));
			result.violation(gap, { group[0].cluster,
									group[0].triangle,
									points[i].first,
									fmt::format("two micro-triangles place the point {:.3g} mesh units apart", gap),
									{} });
		}
	const auto same = [&](const auto& a, const auto& b) {
		return key(a) == key(b) && std::memcmp(&a.second, &b.second, sizeof(vec3)) == 0;
	};
	points.erase(std::unique(points.begin(), points.end(), same), points.end());
	return points;
}

void addGroup(const HostScene& scene, std::span<const MicroTriangle> group, Chunk& chunk)
{
	std::array<Side, 3> sides = reference::emptySides(scene, group[0].cluster, group[0].triangle);
	const uint32_t flags = triangleEdgeFlags(scene.base(group[0].cluster, group[0].triangle).flags);
	for (const auto& [domain, displaced] : pointsOf(group, chunk.result))
		for (uint32_t edge = 0; edge < 3; ++edge)
			if (reference::isOnEdge(domain, edge))
				sides[edge].points.push_back({ reference::alongFromLow(domain, edge, (flags >> edge & 1) != 0), displaced });
	for (Side& side : sides)
	{
		std::sort(side.points.begin(), side.points.end(), [](const EdgePoint& a, const EdgePoint& b) { return a.along < b.along; });
		chunk.sides.push_back(std::move(side));
	}
	chunk.topology.addTriangle(group);
}

// Where the side's polyline passes at a distance along the edge.
dvec3 placeAlong(const std::vector<EdgePoint>& points, uint32_t along)
{
	const auto after = std::lower_bound(points.begin(), points.end(), along, [](const EdgePoint& p, uint32_t a) { return p.along < a; });
	if (after == points.end())
		return points.empty() ? dvec3(0) : dvec3(points.back().displaced);
	if (after == points.begin() || after->along == along)
		return dvec3(after->displaced);
	const EdgePoint &low = *(after - 1), &high = *after;
	return glm::mix(dvec3(low.displaced), dvec3(high.displaced), double(along - low.along) / double(high.along - low.along));
}

// The domain point of a side's own triangle.
DomainPoint domainAt(const HostScene& scene, const Side& side, uint32_t along)
{
	const bool from_first = (triangleEdgeFlags(scene.base(side.cluster, side.triangle).flags) >> side.edge & 1) != 0;
	const uint32_t there = from_first ? along : DOMAIN_SIZE - along, here = DOMAIN_SIZE - there;
	const DomainPoint on[3] = { { here, there }, { 0, here }, { there, 0 } };
	return on[side.edge];
}

// Every point that one side has and the other has not, or has elsewhere.
void compareSides(const HostScene& scene, const Side& a, const Side& b, CheckResult& result)
{
	const auto report = [&](const Side& has, const Side& lacks, const EdgePoint& point) {
		const double gap = glm::length(dvec3(point.displaced) - placeAlong(lacks.points, point.along));
		result.violation(gap, { has.cluster,
								has.triangle,
								domainAt(scene, has, point.along),
								fmt::format("triangle {} of cluster {} has no such point on this edge; gap {:.3g} mesh units", lacks.triangle,
											lacks.cluster.cluster, gap),
								{} });
	};
	size_t i = 0, j = 0;
	while (i < a.points.size() || j < b.points.size())
	{
		const bool has_a = i < a.points.size(), has_b = j < b.points.size();
		if (has_a && has_b && a.points[i].along == b.points[j].along)
		{
			if (!sameBits(a.points[i], b.points[j]))
				report(a, b, a.points[i]);
			++i, ++j;
		}
		else if (!has_b || (has_a && a.points[i].along < b.points[j].along))
			report(a, b, a.points[i++]);
		else
			report(b, a, b.points[j++]);
	}
}

void checkEdges(const HostScene& scene, std::vector<const Side*>& sides, CheckResult& result, Topology& topology)
{
	std::stable_sort(sides.begin(), sides.end(), [](const Side* a, const Side* b) { return edgeKey(*a) < edgeKey(*b); });
	for (size_t first = 0, i = 1; i <= sides.size(); ++i)
	{
		if (i < sides.size() && edgeKey(*sides[first]) == edgeKey(*sides[i]))
			continue;
		const size_t count = i - first;
		++result.sums[count == 1 ? "boundary edges" : count == 2 ? "manifold edges" : "non-manifold edges"];
		for (size_t other = first + 1; other < i; ++other)
			compareSides(scene, *sides[first], *sides[other], result);
		result.sums["edge points compared"] += sides[first]->points.size() * (count - 1);
		topology.addEdge(sides[first]->weld_low == sides[first]->weld_high, sides[first]->points.size());
		first = i;
	}
}

}  // namespace

CheckResult checkWatertight(const HostScene& scene, std::span<const MicroTriangle> sorted, bool as_a_whole)
{
	const auto groups = baseTriangles(sorted);
	const auto chunks = reference::inChunks<Chunk>(groups.size(), 64, [&](Chunk& chunk, size_t first, size_t end) {
		for (size_t i = first; i < end; ++i)
			addGroup(scene, groups[i], chunk);
	});
	CheckResult result;
	Topology topology;
	std::vector<const Side*> sides;
	for (const Chunk& chunk : chunks)
	{
		result.merge(chunk.result);
		topology.add(chunk.topology);
		for (const Side& side : chunk.sides)
			sides.push_back(&side);
	}
	checkEdges(scene, sides, result, topology);
	if (as_a_whole)
		topology.check(scene, result);
	return result;
}

}  // namespace tessera::verify
