// pattern.h: which table pattern a triangle with three edge factors uses, and the points of that pattern.
// The table itself is a buffer (tables/ generates it); only its format is known here. Source: DESIGN.md, section 6.
#ifndef TESSERA_SHARED_PATTERN_H
#define TESSERA_SHARED_PATTERN_H
#include "shared/domain.h"

SHARED_BEGIN

// Where a pattern lies in the table's arrays.
struct PatternRange
{
	uint first_triangle;
	uint first_vertex;
	uint counts;  // triangles | vertices << 16
	uint unused;  // to 16 bytes, so that devices read it at once
};
SHARED_LAYOUT(PatternRange, 16, unused, 12)

// The table as a stage sees it.
struct TableView
{
	GPU_PTR(PatternRange) patterns;  // by patternIndex
	GPU_PTR(uint) vertices;          // run-time order: corners, edge points, interior; 2 x 16-bit barycentrics
	GPU_PTR(uint) triangles;         // 3 x 8-bit indices, counter-clockwise
};
SHARED_LAYOUT(TableView, 24, triangles, 16)

SHARED_FN uint patternTriangles(PatternRange pattern)
{
	return pattern.counts & 0xffffu;
}
SHARED_FN uint patternVertices(PatternRange pattern)
{
	return pattern.counts >> 16;
}

// Index of pattern (a, b, c), a >= b >= c >= 1, in increasing order: (1,1,1) (2,1,1) (2,2,1) (2,2,2) (3,1,1) ...
SHARED_FN uint patternIndex(uint a, uint b, uint c)
{
	uint n = a - 1u;
	uint m = b - 1u;
	return n * (n + 1u) * (n + 2u) / 6u + m * (m + 1u) / 2u + (c - 1u);
}

// Puts a piece with corners c0 c1 c2 and edge factors a (c0-c1), b (c1-c2), c (c2-c0) into pattern order:
// the largest factor first, then the larger of the others; an odd reordering sets `mirror`.
SHARED_FN DomainPiece inPatternOrder(DomainPiece piece)
{
	DomainPiece turned = piece;
	bool b_first = piece.b > piece.a && piece.b >= piece.c;
	bool c_first = !b_first && piece.c > piece.a;
	if (b_first)
	{
		turned.c0 = piece.c1;
		turned.c1 = piece.c2;
		turned.c2 = piece.c0;
		turned.a = piece.b;
		turned.b = piece.c;
		turned.c = piece.a;
	}
	if (c_first)
	{
		turned.c0 = piece.c2;
		turned.c1 = piece.c0;
		turned.c2 = piece.c1;
		turned.a = piece.c;
		turned.b = piece.a;
		turned.c = piece.b;
	}
	if (turned.b >= turned.c)
		return turned;
	DomainPiece mirrored = turned;
	mirrored.c0 = turned.c1;
	mirrored.c1 = turned.c0;
	mirrored.b = turned.c;
	mirrored.c = turned.b;
	mirrored.mirror = turned.mirror ^ 1u;
	return mirrored;
}

// Where micro-vertex `index` of a pattern lies: first the corners, then the points of edges a, b, c, then the interior.
struct PatternPlace
{
	uint edge;      // 0 a (corners 0-1), 1 b (1-2), 2 c (2-0), 3 interior
	uint k;         // along the edge, from its first corner; a corner is point 0 of the edge that begins there
	uint segments;  // of the edge
};

SHARED_FN PatternPlace patternPlace(uint index, uint a, uint b, uint c)
{
	uint first_b = 3u + a - 1u;
	uint first_c = first_b + b - 1u;
	uint first_interior = first_c + c - 1u;
	bool on_a = index == 0u || (index >= 3u && index < first_b);
	bool on_b = index == 1u || (index >= first_b && index < first_c);
	PatternPlace place;
	place.edge = index >= first_interior ? 3u : (on_a ? 0u : (on_b ? 1u : 2u));
	place.k = index < 3u ? 0u : index + 1u - (on_a ? 3u : (on_b ? first_b : first_c));
	place.segments = on_a ? a : (on_b ? b : c);
	return place;
}

// Micro-vertex `index` of a piece. Which edge is chosen first and one edge point computed after, so that the lanes of a subgroup stay together.
SHARED_FN DomainPoint patternPoint(DomainPiece piece, uint index, PatternRange pattern, TableView table, uint edge_flags)
{
	PatternPlace place = patternPlace(index, piece.a, piece.b, piece.c);
	if (place.edge == 3u)
		return interiorPoint(piece.c0, piece.c1, piece.c2, AT(uint, table.vertices, pattern.first_vertex + index));
	DomainPoint from = place.edge == 0u ? piece.c0 : (place.edge == 1u ? piece.c1 : piece.c2);
	DomainPoint to = place.edge == 0u ? piece.c1 : (place.edge == 1u ? piece.c2 : piece.c0);
	return edgePoint(from, to, place.k, place.segments, edge_flags);
}

// The three micro-vertices of micro-triangle `index`, in the base triangle's winding.
SHARED_FN uvec3 patternTriangle(uint index, PatternRange pattern, TableView table, uint mirror)
{
	uint packed_indices = AT(uint, table.triangles, pattern.first_triangle + index);
	uint i0 = packed_indices & 0xffu;
	uint i1 = (packed_indices >> 8) & 0xffu;
	uint i2 = (packed_indices >> 16) & 0xffu;
	return mirror != 0u ? uvec3(i1, i0, i2) : uvec3(i0, i1, i2);
}

SHARED_END

#endif
