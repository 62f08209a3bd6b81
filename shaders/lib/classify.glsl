// What becomes of a triangle: a part triangle when its factors fit the table, else a split triangle.
#ifndef TESSERA_LIB_CLASSIFY
#define TESSERA_LIB_CLASSIFY
#include "lib/frame_data.glsl"
#include "shared/bounds.h"
#include "shared/edge_detail.h"
#include "shared/pattern.h"

// A corner of a triangle being classified: its domain point, and its undisplaced position relative to the eye.
struct ClassifiedCorner
{
	DomainPoint domain;
	vec3 relative;
};

#define DECISION_SPLIT 0x1000u
#define DECISION_CULLED 0x2000u  // nothing of it can be in view: it becomes nothing

// Factors (or pieces per edge, with DECISION_SPLIT) of edges p-q, q-r, r-p: 4 bits each.
uint decideTriangle(EdgeBase base, ClassifiedCorner p, ClassifiedCorner q, ClassifiedCorner r, View view, FactorRule rule)
{
	EdgeView edge_a = edgeByMetric(frame_surface, base, p.domain, q.domain, p.relative, q.relative, view);
	EdgeView edge_b = edgeByMetric(frame_surface, base, q.domain, r.domain, q.relative, r.relative, view);
	EdgeView edge_c = edgeByMetric(frame_surface, base, r.domain, p.domain, r.relative, p.relative, view);
	uint a = edgeFactor(edge_a, rule);
	uint b = edgeFactor(edge_b, rule);
	uint c = edgeFactor(edge_c, rule);
	if (a != 0u && b != 0u && c != 0u)
		return a | (b << 4) | (c << 8);
	return edgePieces(edge_a, rule) | (edgePieces(edge_b, rule) << 4) | (edgePieces(edge_c, rule) << 8) | DECISION_SPLIT;
}

// True when nothing of the piece can be in view. `reach`: of the cluster; only with culling.
bool isOutOfView(ClassifiedCorner p, ClassifiedCorner q, ClassifiedCorner r, PlacedReach reach, uint cull_frustum, View view)
{
	return HAS_CULLING && cull_frustum != 0u && !pieceMayBeVisible(p.relative, q.relative, r.relative, reach, view);
}

// The record of a decided triangle, corners turned into pattern order.
DomainTriangle decidedTriangle(uint decision, DomainPoint p, DomainPoint q, DomainPoint r, uint visible_cluster, uint triangle)
{
	DomainPiece piece;
	piece.c0 = p;
	piece.c1 = q;
	piece.c2 = r;
	piece.visible_cluster = visible_cluster;
	piece.triangle = triangle;
	piece.a = decision & 15u;
	piece.b = (decision >> 4) & 15u;
	piece.c = (decision >> 8) & 15u;
	piece.mirror = 0u;
	return packTriangle(inPatternOrder(piece));
}

#endif
