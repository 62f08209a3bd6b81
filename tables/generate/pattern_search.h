// The best pattern found for each number of interior points, and how many each configuration gets.
#pragma once
#include "tables/generate/pattern_mesh.h"

#include <span>

namespace tessera::generate
{

// Numbers of interior points that a pattern may have, both ends included.
struct InteriorRange
{
	uint32_t least = 0;
	uint32_t most = 0;
};

// What the density along the edges asks for (factors a >= b >= c). Source of the two ends: docs/table.md, "Method".
InteriorRange interiorRange(uint32_t a, uint32_t b, uint32_t c);

// Patterns (a, b, c) with range.least..range.most interior points, in this order. Points are added one by one where they help most,
// and all are moved after each. (n, n, n) gives its uniform grid only.
std::vector<PatternMesh> searchPatterns(uint32_t a, uint32_t b, uint32_t c, InteriorRange range);

// Picks one pattern of each list so that together they have at most `triangle_budget` triangles and the sines of their smallest angles
// add up to as much as possible. Returns an index per list; every list's first pattern must fit the budget together.
std::vector<uint32_t> spendTriangles(std::span<const std::vector<PatternMesh>> patterns, uint32_t triangle_budget);

}  // namespace tessera::generate
