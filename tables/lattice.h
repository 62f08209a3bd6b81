// Exact geometry of pattern points: integer barycentrics drawn in the equilateral triangle.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

namespace tessera
{

// 1.0 of a stored barycentric; the side of the equilateral triangle in lattice units.
inline constexpr int32_t kBarycentricOne = 1 << 15;

// Weights of corner 0 (u) and corner 1 (v); corner 2 has the rest. Each in 0..kBarycentricOne inside the triangle.
struct LatticePoint
{
	int32_t u = 0;
	int32_t v = 0;

	int32_t w() const { return kBarycentricOne - u - v; }
	bool operator==(const LatticePoint&) const = default;
};

// Doubled area in units of the lattice cell; positive when p, q, r turn like the corners 0, 1, 2. The whole triangle has 2^30.
inline int64_t doubledArea(LatticePoint p, LatticePoint q, LatticePoint r)
{
	return int64_t(q.u - p.u) * (r.v - p.v) - int64_t(r.u - p.u) * (q.v - p.v);
}

// Twice the dot product of q - p and r - p in the equilateral triangle, in squared lattice units: exact.
inline int64_t doubledDot(LatticePoint p, LatticePoint q, LatticePoint r)
{
	const int64_t qu = q.u - p.u, qv = q.v - p.v, ru = r.u - p.u, rv = r.v - p.v;
	return 2 * qu * ru + qu * rv + qv * ru + 2 * qv * rv;
}

inline int64_t squaredDistance(LatticePoint p, LatticePoint q)
{
	return doubledDot(p, q, q) / 2;
}

// Cotangent of the smallest angle over that of 60 degrees: 1 for the equilateral triangle, growing as it gets thinner,
// infinite for a triangle without area or of the wrong turn. One division of exact integers: the same on every machine.
inline double thinness(LatticePoint p, LatticePoint q, LatticePoint r)
{
	const int64_t area = doubledArea(p, q, r);
	if (area <= 0)
		return std::numeric_limits<double>::infinity();
	const int64_t largest = std::max({ doubledDot(p, q, r), doubledDot(q, r, p), doubledDot(r, p, q) });
	return double(largest) / double(area);
}

// The k-th of n points from 0 to 1, rounded to nearest. Never a tie, so counting from either end gives the same point.
inline int32_t edgeCoordinate(uint32_t k, uint32_t n)
{
	return int32_t((uint32_t(kBarycentricOne) * k + n / 2) / n);
}

}  // namespace tessera
