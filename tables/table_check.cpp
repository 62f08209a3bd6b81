#include "tables/lattice.h"
#include "tables/table.h"

#include <algorithm>

namespace tessera
{

// One config of a table, seen as points and index triples.
struct PatternView
{
	std::array<uint32_t, 3> factors;
	std::vector<LatticePoint> points;
	std::vector<std::array<uint32_t, 3>> triangles;

	template <typename... Args>
	tl::unexpected<Error> broken(fmt::format_string<Args...> format, Args&&... args) const
	{
		const std::string rule = fmt::format(format, std::forward<Args>(args)...);
		return badInput("config ({},{},{}): {}", factors[0], factors[1], factors[2], rule);
	}
	uint32_t rimCount() const { return factors[0] + factors[1] + factors[2]; }
};

static Status checkLimits(const PatternView& pattern, const TessellationTable& table, const TableConfig& config)
{
	const bool small = pattern.factors[0] <= 2;
	const uint32_t max_triangles = small ? kMaxSmallPatternTriangles : kMaxPatternTriangles;
	const uint32_t max_vertices = small ? kMaxSmallPatternVertices : kMaxPatternVertices;
	if (config.triangle_count > max_triangles)
		return pattern.broken("{} triangles are too many, at most {} are allowed", config.triangle_count, max_triangles);
	if (config.vertex_count > max_vertices)
		return pattern.broken("{} vertices are too many, at most {} are allowed", config.vertex_count, max_vertices);
	if (uint64_t(config.first_triangle) + config.triangle_count > table.triangles.size())
		return pattern.broken("triangles {} to {} end after the table's {}", config.first_triangle,
							  uint64_t(config.first_triangle) + config.triangle_count, table.triangles.size());
	if (uint64_t(config.first_vertex) + config.vertex_count > table.vertices.size())
		return pattern.broken("vertices {} to {} end after the table's {}", config.first_vertex, uint64_t(config.first_vertex) + config.vertex_count,
							  table.vertices.size());
	if (config.vertex_count < pattern.rimCount())
		return pattern.broken("{} vertices are too few, its corners and edges have {}", config.vertex_count, pattern.rimCount());
	return {};
}

// Corners and edge points at their exact places, all others strictly inside.
static Status checkPlaces(const PatternView& pattern)
{
	static constexpr std::array<LatticePoint, 3> kCorners = { { { kBarycentricOne, 0 }, { 0, kBarycentricOne }, { 0, 0 } } };
	for (uint32_t i = 0; i < pattern.points.size(); i++)
	{
		const LatticePoint p = pattern.points[i];
		if (p.u > kBarycentricOne || p.v > kBarycentricOne || p.w() < 0)
			return pattern.broken("vertex {}: weights {} and {} leave the triangle, their sum must be at most {}", i, p.u, p.v, kBarycentricOne);
		if (i < 3 && p != kCorners[i])
			return pattern.broken("vertex {} must be corner {}, weights {} and {}", i, i, kCorners[i].u, kCorners[i].v);
		if (i >= pattern.rimCount() && std::min({ p.u, p.v, p.w() }) <= 0)
			return pattern.broken("vertex {} lies on an edge; edges must have exactly {}, {}, {} segments", i, pattern.factors[0], pattern.factors[1],
								  pattern.factors[2]);
	}
	uint32_t i = 3;
	for (uint32_t edge = 0; edge < 3; edge++)
	{
		const uint32_t n = pattern.factors[edge];
		for (uint32_t k = 1; k < n; k++, i++)
		{
			// The weights of the edge's first and second end, and the third, which must be exactly 0.
			const LatticePoint p = pattern.points[i];
			const std::array<int32_t, 3> weights = { p.u, p.v, p.w() };
			const int32_t first = weights[edge], second = weights[(edge + 1) % 3];
			if (first + second != kBarycentricOne)
				return pattern.broken("vertex {}: weights {} and {} along edge {} must sum to {}", i, first, second, "abc"[edge], kBarycentricOne);
			if (second != edgeCoordinate(k, n))
				return pattern.broken("vertex {}: point {} of edge {} is at {}, must be at {}/{} of {}, which is {}", i, k, "abc"[edge], second, k, n,
									  kBarycentricOne, edgeCoordinate(k, n));
		}
	}
	return {};
}

// Every triangle has an area and turns like the corners, and together they have the area of the whole.
static Status checkAreas(const PatternView& pattern)
{
	int64_t sum = 0;
	for (uint32_t t = 0; t < pattern.triangles.size(); t++)
	{
		const auto [i, j, k] = pattern.triangles[t];
		for (const uint32_t index : { i, j, k })
		{
			if (index >= pattern.points.size())
				return pattern.broken("triangle {}: index {} is too large, the config has {} vertices", t, index, pattern.points.size());
		}
		const int64_t area = doubledArea(pattern.points[i], pattern.points[j], pattern.points[k]);
		if (area == 0)
			return pattern.broken("triangle {} ({}, {}, {}) has no area", t, i, j, k);
		if (area < 0)
			return pattern.broken("triangle {} ({}, {}, {}) is clockwise, must be counter-clockwise", t, i, j, k);
		sum += area;
	}
	constexpr int64_t kWhole = int64_t(kBarycentricOne) * kBarycentricOne;
	if (sum != kWhole)
		return pattern.broken("the triangles' areas sum to {} of {}: the triangle must be covered exactly once", sum, kWhole);
	return {};
}

// True when i -> j is a segment of the rim, in the rim's direction.
static bool isRimSegment(const PatternView& pattern, uint32_t from, uint32_t to)
{
	uint32_t first_point = 3;
	for (uint32_t edge = 0; edge < 3; edge++)
	{
		const uint32_t n = pattern.factors[edge];
		const auto at = [&](uint32_t k) {
			return k == 0 ? edge : k == n ? (edge + 1) % 3 : first_point + k - 1;
		};
		for (uint32_t k = 0; k < n; k++)
		{
			if (at(k) == from && at(k + 1) == to)
				return true;
		}
		first_point += n - 1;
	}
	return false;
}

// Every side is shared by exactly two triangles, or is a whole segment of the rim. With all areas positive
// this leaves no gap, no overlap and no T-junction.
static Status checkSides(const PatternView& pattern)
{
	const size_t count = pattern.points.size();
	std::vector<uint8_t> uses(count * count, 0);
	std::vector<uint8_t> used(count, 0);
	for (uint32_t t = 0; t < pattern.triangles.size(); t++)
	{
		for (uint32_t side = 0; side < 3; side++)
		{
			const uint32_t from = pattern.triangles[t][side], to = pattern.triangles[t][(side + 1) % 3];
			used[from] = 1;
			if (uses[from * count + to]++ > 0)
				return pattern.broken("triangle {}: side {} to {} is used twice, the triangles overlap", t, from, to);
		}
	}
	for (uint32_t from = 0; from < count; from++)
	{
		if (!used[from])
			return pattern.broken("vertex {} belongs to no triangle", from);
		for (uint32_t to = 0; to < count; to++)
		{
			if (uses[from * count + to] > 0 && uses[to * count + from] == 0 && !isRimSegment(pattern, from, to))
				return pattern.broken("side {} to {} has no second triangle: a T-junction or a gap", from, to);
		}
	}
	return {};
}

// (n, n, n): every triangle is one of the n x n equal ones.
static Status checkUniform(const PatternView& pattern)
{
	const int64_t n = pattern.factors[0];
	if (int64_t(pattern.triangles.size()) != n * n)
		return pattern.broken("{} triangles, the uniform grid has {}", pattern.triangles.size(), n * n);
	std::vector<LatticePoint> cells;
	for (uint32_t i = 0; i < pattern.points.size(); i++)
	{
		const LatticePoint p = pattern.points[i];
		const auto nearest = [&](int64_t x) {
			return int32_t((x * n + kBarycentricOne / 2) / kBarycentricOne);
		};
		const auto off = [&](int64_t x) {
			return std::abs(x * n - int64_t(nearest(x)) * kBarycentricOne) > n;
		};
		if (off(p.u) || off(p.v) || off(p.w()))
			return pattern.broken("vertex {} ({}, {}) is no point of the uniform grid", i, p.u, p.v);
		cells.push_back({ nearest(p.u), nearest(p.v) });
	}
	for (uint32_t t = 0; t < pattern.triangles.size(); t++)
	{
		const auto [i, j, k] = pattern.triangles[t];
		const auto isUnit = [&](uint32_t from, uint32_t to) {
			const int32_t du = cells[to].u - cells[from].u, dv = cells[to].v - cells[from].v;
			return du * du + du * dv + dv * dv == 1;
		};
		if (!isUnit(i, j) || !isUnit(j, k) || !isUnit(k, i))
			return pattern.broken("triangle {} ({}, {}, {}) is no triangle of the uniform grid", t, i, j, k);
	}
	return {};
}

static Status checkConfig(const TessellationTable& table, const TableConfig& config, const std::array<uint32_t, 3>& factors)
{
	PatternView pattern = { factors, {}, {} };
	TRY(checkLimits(pattern, table, config));
	for (uint32_t i = 0; i < config.vertex_count; i++)
	{
		const uint32_t packed = table.vertices[config.first_vertex + i];
		pattern.points.push_back({ int32_t(packed & 0xffff), int32_t(packed >> 16) });
	}
	for (uint32_t i = 0; i < config.triangle_count; i++)
	{
		const uint32_t packed = table.triangles[config.first_triangle + i];
		if (packed >> 24 != 0)
			return pattern.broken("triangle {}: {:#x} has bits above its three indices", i, packed);
		pattern.triangles.push_back({ packed & 0xff, packed >> 8 & 0xff, packed >> 16 });
	}
	TRY(checkPlaces(pattern));
	TRY(checkAreas(pattern));
	TRY(checkSides(pattern));
	if (factors[0] == factors[2])
		TRY(checkUniform(pattern));
	return {};
}

Status checkTable(const TessellationTable& table)
{
	if (table.max_edge_segments < 2 || table.max_edge_segments > kMaxEdgeSegments)
		return badInput("max_edge_segments is {}, must be 2 to {}", table.max_edge_segments, kMaxEdgeSegments);
	const std::vector<std::array<uint32_t, 3>> factors = configFactors(table.max_edge_segments);
	if (table.configs.size() != factors.size())
		return badInput("{} configs, max_edge_segments {} needs {}", table.configs.size(), table.max_edge_segments, factors.size());
	for (size_t i = 0; i < factors.size(); i++)
		TRY(checkConfig(table, table.configs[i], factors[i]));
	return {};
}

}  // namespace tessera
