// How good a table is: thin triangles, count, reuse of vertices. Reported by the build target `table_quality`.
#pragma once
#include "tables/table.h"

#include <span>
#include <string>

namespace tessera
{

// Of one config, drawn in the equilateral triangle.
struct ConfigQuality
{
	std::array<uint32_t, 3> factors = {};
	uint32_t triangle_count = 0;
	uint32_t vertex_count = 0;
	uint32_t least_triangles = 0;     // a + b + c - 2: no interior point; n x n for (n, n, n)
	double smallest_angle_deg = 0;    // 60 at best
	double worst_aspect = 0;          // longest side over the height on it; 1.15 at best
	double fetches_per_triangle = 0;  // vertices not among the last kReuseWindow fetched ones, in emission order; 0.5 to 3
};

// Of the whole table, over its configs.
struct TableQuality
{
	std::vector<ConfigQuality> configs;  // in the table's order
	uint32_t triangle_count = 0;
	uint32_t vertex_count = 0;
	uint32_t least_triangles = 0;
	double mean_angle_deg = 0;  // of the configs' smallest angles
	double median_angle_deg = 0;
	ConfigQuality worst_angle;        // the config with the smallest angle
	ConfigQuality worst_aspect;       // the config with the worst aspect
	double fetches_per_triangle = 0;  // over all triangles
};

inline constexpr uint32_t kReuseWindow = 16;

// Vertices to fetch for triangles (i | j << 8 | k << 16, each index < 256) in this order when the last kReuseWindow fetched ones are kept.
uint32_t countFetches(std::span<const uint32_t> triangles);

// Measures a table that passes checkTable.
TableQuality measureTable(const TessellationTable& table);

// The quality as Markdown: the summary, then every config when `every_config`, or the examples that docs/table.md compares.
std::string qualityReport(const TableQuality& quality, bool every_config);

}  // namespace tessera
