// Tessellation table: how a triangle whose edges have a, b, c segments is cut, for all 1 <= c <= b <= a <= max_edge_segments.
// Edge a joins corners 0 and 1, edge b corners 1 and 2, edge c corners 2 and 0. The other orders of factors are turns and mirrors.
#pragma once
#include "base/result.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace tessera
{

inline constexpr uint32_t kMaxEdgeSegments = 11;          // of any table: the limits below end there
inline constexpr uint32_t kMaxPatternTriangles = 128;     // of one pattern
inline constexpr uint32_t kMaxPatternVertices = 96;       // of one pattern
inline constexpr uint32_t kMaxSmallPatternTriangles = 4;  // of a pattern up to (2, 2, 2)
inline constexpr uint32_t kMaxSmallPatternVertices = 6;   // of a pattern up to (2, 2, 2)

// One pattern: its ranges of the table's lists.
struct TableConfig
{
	uint32_t first_triangle = 0;
	uint32_t first_vertex = 0;
	uint16_t triangle_count = 0;
	uint16_t vertex_count = 0;
};

// Vertices of a config are in run-time order: 3 corners, the a - 1 points of edge a in order from corner 0 to 1, the b - 1 of edge b
// from 1 to 2, the c - 1 of edge c from 2 to 0, then the interior points.
struct TessellationTable
{
	uint32_t max_edge_segments = kMaxEdgeSegments;
	std::vector<uint32_t> vertices;    // u | v << 16: weights of corner 0 and corner 1, 1 << 15 = 1.0; corner 2 has the rest
	std::vector<uint32_t> triangles;   // i0 | i1 << 8 | i2 << 16: vertices of the config, turning like corners 0, 1, 2 (counter-clockwise)
	std::vector<TableConfig> configs;  // in the order (1,1,1), (2,1,1), (2,2,1), (2,2,2), (3,1,1), ...
};

// Number of configs of a table up to `max_edge_segments`: 286 for 11.
constexpr uint32_t configCount(uint32_t max_edge_segments)
{
	return max_edge_segments * (max_edge_segments + 1) * (max_edge_segments + 2) / 6;
}

// Place of (a, b, c) in TessellationTable::configs; a >= b >= c >= 1.
constexpr uint32_t configIndex(uint32_t a, uint32_t b, uint32_t c)
{
	return (a - 1) * a * (a + 1) / 6 + (b - 1) * b / 2 + (c - 1);
}

// The (a, b, c) of every config up to `max_edge_segments`, in the table's order.
std::vector<std::array<uint32_t, 3>> configFactors(uint32_t max_edge_segments);

// How a triangle uses the table.
struct PatternUse
{
	uint32_t config = 0;                                // index into TessellationTable::configs
	std::array<uint8_t, 3> corner_order = { 0, 1, 2 };  // pattern corner i lies on the triangle's corner corner_order[i]
	bool mirror = false;                                // the pattern is turned over: emit its triangles with two indices swapped
};

// Turns or mirrors a triangle so that its factors are sorted. f01 is the factor of the edge between corners 0 and 1, and so on; each
// in 1..max_edge_segments. Among equal factors a turn is preferred to a mirror, and a smaller turn to a larger one.
PatternUse usePattern(uint32_t f01, uint32_t f12, uint32_t f20);

// The table made by the build (tables/generate/). The same on every machine.
const TessellationTable& defaultTable();

// Holds a table to every rule of docs/formats.md, "Tessellation table". Errors: BadInput, one line that names the config
// and the broken rule.
Status checkTable(const TessellationTable& table);

// Reads a table file (docs/formats.md, "Tessellation table") and puts its vertices into run-time order.
// Errors: BadInput, one line with the file, the config or the entry, and the broken rule.
Result<TessellationTable> loadTable(const std::filesystem::path& path);

// Writes a table that loadTable reads. Errors: those of writeFile.
Status saveTable(const TessellationTable& table, const std::filesystem::path& path);

}  // namespace tessera
