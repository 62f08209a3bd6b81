#include "base/file.h"
#include "tables/lattice.h"
#include "tables/table.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace tessera
{

using nlohmann::json;

static constexpr uint64_t kMaxFileBytes = 64 << 20;

// The file's lists, checked to be numbers that fit, before vertices are put into order.
struct RawTable
{
	uint32_t max_edge_segments = 0;
	std::vector<LatticePoint> vertices;
	std::vector<std::array<uint32_t, 3>> triangles;
	std::vector<TableConfig> configs;
};

// A whole number in 0..most at `value`, or nothing.
static bool readNumber(const json& value, uint64_t most, uint64_t& number)
{
	if (!value.is_number_unsigned() || value.get<uint64_t>() > most)
		return false;
	number = value.get<uint64_t>();
	return true;
}

// An entry packed into one number (`bits` per part, the first lowest) or written as an array of its parts.
template <size_t Count>
static bool readParts(const json& value, uint32_t bits, std::array<uint32_t, Count>& parts)
{
	uint64_t number = 0;
	const uint64_t most = (uint64_t(1) << bits) - 1;
	if (value.is_array())
	{
		for (size_t i = 0; i < Count; i++)
		{
			if (value.size() != Count || !readNumber(value[i], most, number))
				return false;
			parts[i] = uint32_t(number);
		}
		return true;
	}
	if (!readNumber(value, (uint64_t(1) << (bits * Count)) - 1, number))
		return false;
	for (size_t i = 0; i < Count; i++)
		parts[i] = uint32_t(number >> (bits * i) & most);
	return true;
}

static Result<const json*> findArray(const json& file, const char* key)
{
	const auto found = file.find(key);
	if (found == file.end() || !found->is_array())
		return badInput("\"{}\" must be an array", key);
	return &*found;
}

static Result<TableConfig> readConfig(const json& value, size_t index)
{
	static constexpr std::array<const char*, 4> kKeys = { "firstTriangle", "firstVertex", "numTriangles", "numVertices" };
	static constexpr std::array<uint64_t, 4> kMost = { 0xffffffff, 0xffffffff, 0xffff, 0xffff };
	std::array<uint64_t, 4> numbers = {};
	for (size_t i = 0; i < kKeys.size(); i++)
	{
		if (!value.is_object() || !value.contains(kKeys[i]) || !readNumber(value[kKeys[i]], kMost[i], numbers[i]))
			return badInput("configs[{}]: \"{}\" must be a whole number from 0 to {}", index, kKeys[i], kMost[i]);
	}
	return TableConfig{ uint32_t(numbers[0]), uint32_t(numbers[1]), uint16_t(numbers[2]), uint16_t(numbers[3]) };
}

static Result<RawTable> readLists(const json& file)
{
	RawTable raw;
	uint64_t segments = 0;
	if (!file.is_object() || !file.contains("max_edge_segments") || !readNumber(file["max_edge_segments"], kMaxEdgeSegments, segments) ||
		segments < 2)
		return badInput("\"max_edge_segments\" must be a whole number from 2 to {}", kMaxEdgeSegments);
	raw.max_edge_segments = uint32_t(segments);

	TRY_ASSIGN(const json* vertices, findArray(file, "vertices"));
	for (size_t i = 0; i < vertices->size(); i++)
	{
		std::array<uint32_t, 2> uv = {};
		if (!readParts((*vertices)[i], 16, uv))
			return badInput("vertices[{}] must be u + 65536 v or [u, v], each from 0 to {}", i, kBarycentricOne);
		raw.vertices.push_back({ int32_t(uv[0]), int32_t(uv[1]) });
	}
	TRY_ASSIGN(const json* triangles, findArray(file, "triangles"));
	for (size_t i = 0; i < triangles->size(); i++)
	{
		std::array<uint32_t, 3> indices = {};
		if (!readParts((*triangles)[i], 8, indices))
			return badInput("triangles[{}] must be i + 256 j + 65536 k or [i, j, k], each from 0 to 255", i);
		raw.triangles.push_back(indices);
	}
	TRY_ASSIGN(const json* configs, findArray(file, "configs"));
	for (size_t i = 0; i < configs->size(); i++)
	{
		TRY_ASSIGN(const TableConfig config, readConfig((*configs)[i], i));
		raw.configs.push_back(config);
	}
	return raw;
}

// Vertices of one config of the file, and which of their weights belongs to corner 0, 1, 2.
struct PatternReader
{
	std::array<uint32_t, 3> factors;
	std::vector<std::array<int32_t, 3>> weights;  // u, v, w as the file has them
	std::array<uint8_t, 3> roles = { 0, 1, 2 };   // corner i has weight roles[i]

	int32_t weight(uint32_t vertex, uint32_t corner) const { return weights[vertex][roles[corner]]; }
	bool isCorner(uint32_t vertex, uint32_t corner) const { return weight(vertex, corner) == kBarycentricOne; }
	bool onEdge(uint32_t vertex, uint32_t edge) const
	{
		const int32_t first = weight(vertex, edge), second = weight(vertex, (edge + 1) % 3);
		return first > 0 && second > 0 && first + second == kBarycentricOne;
	}
	uint32_t countSegments(uint32_t edge) const
	{
		uint32_t count = 1;
		for (uint32_t i = 0; i < weights.size(); i++)
			count += onEdge(i, edge);
		return count;
	}
	template <typename... Args>
	tl::unexpected<Error> broken(fmt::format_string<Args...> format, Args&&... args) const
	{
		const std::string rule = fmt::format(format, std::forward<Args>(args)...);
		return badInput("config ({},{},{}): {}", factors[0], factors[1], factors[2], rule);
	}
};

// Finds which corner of the file is corner 0, 1, 2: the order in which the edges have a, b, c segments. Turns come before mirrors.
// Returns whether it is a mirror.
static Result<bool> findRoles(PatternReader& reader)
{
	static constexpr std::array<std::array<uint8_t, 3>, 6> kOrders = {
		{ { 0, 1, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 1, 0, 2 }, { 0, 2, 1 }, { 2, 1, 0 } }
	};
	for (uint32_t i = 0; i < kOrders.size(); i++)
	{
		reader.roles = kOrders[i];
		const std::array<uint32_t, 3> segments = { reader.countSegments(0), reader.countSegments(1), reader.countSegments(2) };
		if (segments == reader.factors)
			return i >= 3;
	}
	reader.roles = kOrders[0];
	return reader.broken("edges have {}, {}, {} segments, must have {}, {}, {} (weights of edge points must sum to exactly {})",
						 reader.countSegments(0), reader.countSegments(1), reader.countSegments(2), reader.factors[0], reader.factors[1],
						 reader.factors[2], kBarycentricOne);
}

// The file's vertices of a config in run-time order.
static Result<std::vector<uint32_t>> runTimeOrder(const PatternReader& reader)
{
	std::vector<uint32_t> order;
	const uint32_t count = uint32_t(reader.weights.size());
	for (uint32_t corner = 0; corner < 3; corner++)
	{
		for (uint32_t i = 0; i < count; i++)
		{
			if (reader.isCorner(i, corner))
				order.push_back(i);
		}
		if (order.size() != corner + 1)
			return reader.broken("each corner must be exactly one of its vertices");
	}
	for (uint32_t edge = 0; edge < 3; edge++)
	{
		const size_t first = order.size();
		for (uint32_t i = 0; i < count; i++)
		{
			if (reader.onEdge(i, edge))
				order.push_back(i);
		}
		const auto along = [&](uint32_t i, uint32_t j) {
			return reader.weight(i, (edge + 1) % 3) < reader.weight(j, (edge + 1) % 3);
		};
		std::stable_sort(order.begin() + std::ptrdiff_t(first), order.end(), along);
	}
	const std::vector<uint32_t> rim = order;
	for (uint32_t i = 0; i < count; i++)
	{
		if (std::find(rim.begin(), rim.end(), i) == rim.end())
			order.push_back(i);
	}
	return order;
}

// The two weights of a vertex in the table's form. Edge points next to their exact place, rounded either way, get the table's own rounding.
static uint32_t packVertex(const PatternReader& reader, uint32_t vertex, uint32_t place)
{
	std::array<int32_t, 3> weights = { reader.weight(vertex, 0), reader.weight(vertex, 1), reader.weight(vertex, 2) };
	uint32_t first = 3;  // place of the edge's first point
	for (uint32_t edge = 0; edge < 3; edge++)
	{
		const uint32_t n = reader.factors[edge];
		if (place >= first && place < first + n - 1)
		{
			const uint32_t k = place - first + 1;
			const int32_t exact = edgeCoordinate(k, n);
			int32_t& along = weights[(edge + 1) % 3];
			const bool is_next_to_exact = std::abs(along * int32_t(n) - int32_t(k) * kBarycentricOne) < int32_t(n);
			along = is_next_to_exact ? exact : along;
			weights[edge] = kBarycentricOne - along;
		}
		first += n - 1;
	}
	return uint32_t(weights[0]) | uint32_t(weights[1]) << 16;
}

static Status appendConfig(const RawTable& raw, const TableConfig& config, const std::array<uint32_t, 3>& factors, TessellationTable& table)
{
	PatternReader reader = { factors, {}, {} };
	if (uint64_t(config.first_vertex) + config.vertex_count > raw.vertices.size() || config.vertex_count > kMaxPatternVertices)
		return reader.broken("{} vertices from {} on; a config has at most {} and the file {}", config.vertex_count, config.first_vertex,
							 kMaxPatternVertices, raw.vertices.size());
	if (uint64_t(config.first_triangle) + config.triangle_count > raw.triangles.size() || config.triangle_count > kMaxPatternTriangles)
		return reader.broken("{} triangles from {} on; a config has at most {} and the file {}", config.triangle_count, config.first_triangle,
							 kMaxPatternTriangles, raw.triangles.size());
	for (uint32_t i = 0; i < config.vertex_count; i++)
	{
		const LatticePoint p = raw.vertices[config.first_vertex + i];
		if (p.w() < 0)
			return reader.broken("vertex {}: weights {} and {} leave the triangle, their sum must be at most {}", i, p.u, p.v, kBarycentricOne);
		reader.weights.push_back({ p.u, p.v, p.w() });
	}
	TRY_ASSIGN(const bool mirror, findRoles(reader));
	TRY_ASSIGN(const std::vector<uint32_t> order, runTimeOrder(reader));

	std::vector<uint32_t> place_of(order.size());
	table.configs.push_back({ uint32_t(table.triangles.size()), uint32_t(table.vertices.size()), config.triangle_count, config.vertex_count });
	for (uint32_t place = 0; place < order.size(); place++)
	{
		place_of[order[place]] = place;
		table.vertices.push_back(packVertex(reader, order[place], place));
	}
	for (uint32_t t = 0; t < config.triangle_count; t++)
	{
		std::array<uint32_t, 3> corners = raw.triangles[config.first_triangle + t];
		for (uint32_t& corner : corners)
		{
			if (corner >= order.size())
				return reader.broken("triangle {}: index {} is too large, the config has {} vertices", t, corner, order.size());
			corner = place_of[corner];
		}
		if (mirror)
			std::swap(corners[1], corners[2]);
		table.triangles.push_back(corners[0] | corners[1] << 8 | corners[2] << 16);
	}
	return {};
}

static Result<TessellationTable> readTable(const json& file)
{
	TRY_ASSIGN(const RawTable raw, readLists(file));
	const std::vector<std::array<uint32_t, 3>> factors = configFactors(raw.max_edge_segments);
	if (raw.configs.size() != factors.size())
		return badInput("{} configs, max_edge_segments {} needs {}", raw.configs.size(), raw.max_edge_segments, factors.size());
	TessellationTable table;
	table.max_edge_segments = raw.max_edge_segments;
	for (size_t i = 0; i < factors.size(); i++)
		TRY(appendConfig(raw, raw.configs[i], factors[i], table));
	TRY(checkTable(table));
	return table;
}

Result<TessellationTable> loadTable(const std::filesystem::path& path)
{
	TRY_ASSIGN(const std::vector<std::byte> bytes, readFile(path, kMaxFileBytes));
	const char* text = reinterpret_cast<const char*>(bytes.data());
	const json file = json::parse(text, text + bytes.size(), nullptr, false);
	if (file.is_discarded())
		return badInput("{}: is no JSON; a tessellation table has the keys max_edge_segments, vertices, triangles, configs", path.string());
	Result<TessellationTable> table = readTable(file);
	if (!table)
		return fail(table.error().code, "{}: {}", path.string(), table.error().message);
	return table;
}

Status saveTable(const TessellationTable& table, const std::filesystem::path& path)
{
	json configs = json::array();
	for (const TableConfig& config : table.configs)
	{
		configs.push_back({ { "firstTriangle", config.first_triangle },
							{ "firstVertex", config.first_vertex },
							{ "numTriangles", config.triangle_count },
							{ "numVertices", config.vertex_count } });
	}
	const json file = {
		{ "max_edge_segments", table.max_edge_segments }, { "vertices", table.vertices }, { "triangles", table.triangles }, { "configs", configs }
	};
	return writeFile(path, file.dump() + "\n");
}

}  // namespace tessera
