// domain.h: integer barycentric coordinates inside a base triangle, and the records of part and split triangles.
// Positions along edges are decided here, in integers, so that both sides of an edge agree by construction.
// Source: DESIGN.md, section 5.
#ifndef TESSERA_SHARED_DOMAIN_H
#define TESSERA_SHARED_DOMAIN_H
#include "shared/lang.h"

SHARED_BEGIN

#define DOMAIN_SIZE 8388608u  // u + v + w of every domain point: 2^23

// A point of a base triangle: u belongs to corner 0, v to corner 1, w = DOMAIN_SIZE - u - v to corner 2.
struct DomainPoint
{
	uint u;
	uint v;
};
SHARED_LAYOUT(DomainPoint, 8, v, 4)

// A base triangle or a piece of one: the record of part_triangles and split_triangles. Packed by packTriangle.
struct DomainTriangle
{
	uint words[6];
};
SHARED_LAYOUT(DomainTriangle, 24, words, 0)

// The same, unpacked. Corners are in pattern order: a = segments of edge c0-c1 >= b (c1-c2) >= c (c2-c0).
struct DomainPiece
{
	DomainPoint c0;
	DomainPoint c1;
	DomainPoint c2;
	uint visible_cluster;  // index into visible_clusters, 24 bits
	uint triangle;         // within the cluster, 7 bits
	uint a;                // part triangle: tess factors; split triangle: pieces per edge; 1..15
	uint b;
	uint c;
	uint mirror;  // 1: corner order is mirrored, what the pattern emits has to be turned over
};

SHARED_FN uint domainW(DomainPoint p)
{
	return DOMAIN_SIZE - p.u - p.v;
}

SHARED_FN DomainPoint domainCorner(uint corner)
{
	DomainPoint p;
	p.u = corner == 0u ? DOMAIN_SIZE : 0u;
	p.v = corner == 1u ? DOMAIN_SIZE : 0u;
	return p;
}

SHARED_FN DomainTriangle packTriangle(DomainPiece piece)
{
	DomainTriangle t;
	t.words[0] = piece.c0.u | ((piece.visible_cluster & 0xffu) << 24);
	t.words[1] = piece.c0.v | (((piece.visible_cluster >> 8) & 0xffu) << 24);
	t.words[2] = piece.c1.u | (((piece.visible_cluster >> 16) & 0xffu) << 24);
	t.words[3] = piece.c1.v | ((piece.triangle | (piece.mirror << 7)) << 24);
	t.words[4] = piece.c2.u | ((piece.a | (piece.b << 4)) << 24);
	t.words[5] = piece.c2.v | (piece.c << 24);
	return t;
}

SHARED_FN DomainPiece unpackTriangle(DomainTriangle t)
{
	DomainPiece piece;
	piece.c0.u = t.words[0] & 0xffffffu;
	piece.c0.v = t.words[1] & 0xffffffu;
	piece.c1.u = t.words[2] & 0xffffffu;
	piece.c1.v = t.words[3] & 0xffffffu;
	piece.c2.u = t.words[4] & 0xffffffu;
	piece.c2.v = t.words[5] & 0xffffffu;
	piece.visible_cluster = (t.words[0] >> 24) | ((t.words[1] >> 24) << 8) | ((t.words[2] >> 24) << 16);
	piece.triangle = (t.words[3] >> 24) & 0x7fu;
	piece.mirror = t.words[3] >> 31;
	piece.a = (t.words[4] >> 24) & 0xfu;
	piece.b = t.words[4] >> 28;
	piece.c = (t.words[5] >> 24) & 0xfu;
	return piece;
}

// True when the points of edge p-q are counted from p. `edge_flags`: bit e is set when base edge e (from corner e to
// corner e + 1) starts at its end with the lower weld id. Along a base edge the flag decides, inside the packed coordinates.
SHARED_FN bool countsFromFirst(DomainPoint p, DomainPoint q, uint edge_flags)
{
	if (domainW(p) == 0u && domainW(q) == 0u)
		return ((edge_flags & 1u) != 0u) == (p.u > q.u);
	if (p.u == 0u && q.u == 0u)
		return ((edge_flags & 2u) != 0u) == (p.v > q.v);
	if (p.v == 0u && q.v == 0u)
		return ((edge_flags & 4u) != 0u) == (p.u < q.u);
	return p.u < q.u || (p.u == q.u && p.v < q.v);
}

// Multiplier of divideBy: floor(x / n) = (x * m) >> 32 for x below 2^28, since m n exceeds 2^32 by at most n <= 15.
SHARED_FN uint divisionMultiplier(uint n)
{
	return 0xffffffffu / n + 1u;
}
SHARED_FN uint divideBy(uint x, uint n, uint multiplier)
{
	return n == 1u ? x : uint((uint64_t(x) * uint64_t(multiplier)) >> 32);
}

// from +- (|to - from| * k + n / 2) / n, in magnitudes: signed division would truncate towards zero and open cracks.
SHARED_FN uint domainAlong(uint from, uint to, uint k, uint n, uint multiplier)
{
	uint distance = max(from, to) - min(from, to);
	uint offset = divideBy(distance * k + n / 2u, n, multiplier);
	return to >= from ? from + offset : from - offset;
}

// edgePoint, given what is the same for all points of an edge.
SHARED_FN DomainPoint edgePointAlong(DomainPoint p, DomainPoint q, uint k, uint n, uint multiplier, bool from_first)
{
	uint steps = from_first ? k : n - k;
	DomainPoint point;
	point.u = domainAlong(from_first ? p.u : q.u, from_first ? q.u : p.u, steps, n, multiplier);
	point.v = domainAlong(from_first ? p.v : q.v, from_first ? q.v : p.v, steps, n, multiplier);
	return point;
}

// The k-th of n points (0 <= k <= n <= 15) from p to q; the same integers for whoever asks from either end.
SHARED_FN DomainPoint edgePoint(DomainPoint p, DomainPoint q, uint k, uint n, uint edge_flags)
{
	return edgePointAlong(p, q, k, n, divisionMultiplier(n), countsFromFirst(p, q, edge_flags));
}

SHARED_FN uint weightedSum(uint a, uint b, uint c, uint wa, uint wb, uint wc)
{
	uint64_t sum = uint64_t(a) * uint64_t(wa) + uint64_t(b) * uint64_t(wb) + uint64_t(c) * uint64_t(wc);
	return uint((sum + uint64_t(16384u)) >> 15);
}

// An interior point of a pattern. `weights`: table vertex, 16-bit barycentrics of corners 0 and 1, 1 << 15 = 1.
SHARED_FN DomainPoint interiorPoint(DomainPoint c0, DomainPoint c1, DomainPoint c2, uint weights)
{
	uint wa = weights & 0xffffu;
	uint wb = weights >> 16;
	uint wc = 32768u - wa - wb;
	DomainPoint point;
	point.u = weightedSum(c0.u, c1.u, c2.u, wa, wb, wc);
	point.v = weightedSum(c0.v, c1.v, c2.v, wa, wb, wc);
	return point;
}

// Length of an edge in domain units: the largest of |du|, |dv|, |dw|.
SHARED_FN uint domainLength(DomainPoint p, DomainPoint q)
{
	uint du = max(p.u, q.u) - min(p.u, q.u);
	uint dv = max(p.v, q.v) - min(p.v, q.v);
	uint dw = max(domainW(p), domainW(q)) - min(domainW(p), domainW(q));
	return max(du, max(dv, dw));
}

SHARED_END

#endif
