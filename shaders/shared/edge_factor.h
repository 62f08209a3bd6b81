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
	float unit_squared;    // squared length that one segment should have: s^2 * d^2, d to the nearer end; out of view more
	uint limit;            // most segments: an eighth of the edge's length in domain units
};

// Limits of the table and of one split.
struct FactorRule
{
	uint table_size;  // T, 1..15: largest factor of a pattern, less at very coarse rates (scene/factor_rule.h)
	uint max_split;   // pieces per edge of one split, 2..T
};
SHARED_LAYOUT(FactorRule, 8, max_split, 4)

// What an edge out of view adds to the squared distance that decides its segments, where light's rays alone meet it: (X o)^2 with o how far the edge
// as a whole lies beyond the view's side that it is farthest beyond, less `reach`, which is how far a base triangle reaches from any of its points.
// So it is 0 for every edge of a triangle that can touch the picture, grows from there without a step, and never falls from an edge to a part of
// it (splitting ends). Rounding is covered by side_x_from, side_y_from and behind_from. docs/numerics.md
SHARED_FN precise float unseenSquared(vec3 p, vec3 q, float reach, View view)
{
	precise float ahead_p = affineRow(view.ahead, p, 0.0f);
	precise float ahead_q = affineRow(view.ahead, q, 0.0f);
	precise float x_p = affineRow(view.side_x, p, 0.0f);
	precise float x_q = affineRow(view.side_x, q, 0.0f);
	precise float y_p = affineRow(view.side_y, p, 0.0f);
	precise float y_q = affineRow(view.side_y, q, 0.0f);
	precise float inner_x_p = ahead_p * view.side_x_ahead;
	precise float inner_x_q = ahead_q * view.side_x_ahead;
	precise float inner_y_p = ahead_p * view.side_y_ahead;
	precise float inner_y_q = ahead_q * view.side_y_ahead;
	precise float right = min(x_p - inner_x_p, x_q - inner_x_q);
	precise float left = min(-x_p - inner_x_p, -x_q - inner_x_q);
	precise float above = min(y_p - inner_y_p, y_q - inner_y_q);
	precise float below = min(-y_p - inner_y_p, -y_q - inner_y_q);
	precise float behind = min(-ahead_p, -ahead_q) - view.behind_from;
	precise float beside = max(right, left) - view.side_x_from;
	precise float over = max(above, below) - view.side_y_from;
	precise float farthest = max(behind, max(beside, over)) - reach;
	precise float beyond = max(farthest, 0.0f);
	precise float squared = beyond * beyond;
	precise float grown = squared * view.unseen_growth;
	return grown;
}

// The edge between camera-relative points p and q; `unseen_squared`: of unseenSquared. Symmetric in its ends by construction.
SHARED_FN EdgeView viewEdge(vec3 p, vec3 q, uint domain_length, float unseen_squared, View view)
{
	precise float x = p.x - q.x;
	precise float y = p.y - q.y;
	precise float z = p.z - q.z;
	precise float xy = x * x + y * y;
	precise float length_squared = xy + z * z;
	precise float distance_squared = min(rateDistanceSquared(p, view), rateDistanceSquared(q, view));
	if (HAS_RAY_FALLOFF)
		distance_squared = distance_squared + unseen_squared;
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
