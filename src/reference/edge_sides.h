// What base triangles have along their edges, so that those that share one can be compared.
#pragma once
#include "reference/piece_groups.h"

#include <array>
#include <cstring>
#include <vector>

namespace tessera::reference
{

// A micro-vertex on a base edge, by its distance from the end with the lower welded vertex.
struct EdgePoint
{
	uint32_t along;  // 0..DOMAIN_SIZE
	vec3 displaced;
};

inline bool sameBits(const EdgePoint& a, const EdgePoint& b)
{
	return a.along == b.along && std::memcmp(&a.displaced, &b.displaced, sizeof(vec3)) == 0;
}

// What one base triangle has along one of its edges.
struct Side
{
	uint32_t weld_low, weld_high;
	ClusterRef cluster;
	uint32_t triangle, edge;
	std::vector<EdgePoint> points;  // in order
};

// Sides of one edge have the same.
inline auto edgeKey(const Side& side)
{
	return std::array<uint32_t, 3>{ side.cluster.instance, side.weld_low, side.weld_high };
}

// `from_first`: the edge's first corner has the lower welded vertex.
inline uint32_t alongFromLow(DomainPoint p, uint32_t edge, bool from_first)
{
	return from_first ? alongEdge(p, edge) : DOMAIN_SIZE - alongEdge(p, edge);
}

// The three sides of a base triangle, still without points.
inline std::array<Side, 3> emptySides(const HostScene& scene, ClusterRef ref, uint32_t triangle)
{
	const BaseTriangle base = scene.base(ref, triangle);
	const uint32_t vertices[3] = { base.v0, base.v1, base.v2 };
	std::array<Side, 3> sides;
	for (uint32_t edge = 0; edge < 3; ++edge)
	{
		const uint32_t first = scene.built().weld_ids[vertices[edge]], second = scene.built().weld_ids[vertices[(edge + 1) % 3]];
		sides[edge] = { std::min(first, second), std::max(first, second), ref, triangle, edge, {} };
	}
	return sides;
}

}  // namespace tessera::reference
