// edge_factor.h: how many segments an edge gets. A factor is never formed, it is compared: every device rounds the
// products alike, so all shaders, both sides of the edge and the CPU reference agree. Source: DESIGN.md, section 5.
#ifndef TESSERA_SHARED_EDGE_FACTOR_H
#define TESSERA_SHARED_EDGE_FACTOR_H
#include "shared/view.h"

SHARED_BEGIN

// What both sides of an edge know about it.
struct EdgeView
{
	float length_squared;  // of the undisplaced edge, scaled world units squared
	float unit_squared;    // squared length that one segment should have: s^2 * d^2, d to the nearer end
	uint limit;            // most segments: an eighth of the edge's length in domain units
};

// Limits of the table and of one split.
struct FactorRule
{
	uint table_size;  // T, 1..15: largest factor of a pattern, less at very coarse rates (scene/factor_rule.h)
	uint max_split;   // pieces per edge of one split, 2..T
};
SHARED_LAYOUT(FactorRule, 8, max_split, 4)

// The edge between camera-relative points p and q. Symmetric in its ends by construction.
SHARED_FN EdgeView viewEdge(vec3 p, vec3 q, uint domain_length, View view)
{
	precise float x = p.x - q.x;
	precise float y = p.y - q.y;
	precise float z = p.z - q.z;
	precise float xy = x * x + y * y;
	precise float length_squared = xy + z * z;
	precise float distance_squared = min(rateDistanceSquared(p, view), rateDistanceSquared(q, view));
	precise float unit_squared = distance_squared * view.rate_over_focal_squared;
	EdgeView edge;
	edge.length_squared = length_squared;
	edge.unit_squared = unit_squared;
	edge.limit = domain_length / 8u;
	return edge;
}

// True when the edge gets at least `c` segments. Infinity on the right gives false (factor 1), zero true (the limit).
SHARED_FN bool edgeHasAtLeast(uint c, EdgeView edge)
{
	precise float middle = float(c) - 0.5f;
	precise float squared = middle * middle;
	precise float bound = squared * edge.unit_squared;
	return c <= 1u || (c <= edge.limit && edge.length_squared >= bound);
}

// The edge's factor when it is at most T, else 0. Binary search over 1..T, the same comparisons everywhere.
SHARED_FN uint edgeFactor(EdgeView edge, FactorRule rule)
{
	if (edgeHasAtLeast(rule.table_size + 1u, edge))
		return 0u;
	uint low = 1u;
	uint high = rule.table_size;
	while (low < high)
	{
		uint middle = (low + high + 1u) / 2u;
		if (edgeHasAtLeast(middle, edge))
			low = middle;
		else
			high = middle - 1u;
	}
	return low;
}

// Pieces that an edge is cut into when its triangle is split: min(ceil(f / T), cap), 1 when its factor fits the table.
SHARED_FN uint edgePieces(EdgeView edge, FactorRule rule)
{
	uint pieces = 1u;
	while (pieces < rule.max_split && edgeHasAtLeast(rule.table_size * pieces + 1u, edge))
		++pieces;
	return pieces;
}

SHARED_END

#endif
