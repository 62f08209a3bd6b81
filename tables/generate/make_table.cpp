// Makes the default table and writes it as C++: tessera_make_table OUTPUT.cpp
#include "base/file.h"
#include "tables/generate/emission_order.h"
#include "tables/generate/pattern_search.h"
#include "tables/table_quality.h"

namespace tessera::generate
{

// All configs together have no more triangles than the best table published so far (docs/table.md).
static constexpr uint32_t kTriangleBudget = 8398;

static void appendPattern(const PatternMesh& mesh, TessellationTable& table)
{
	std::vector<uint32_t> triangles;
	for (const Triangle& t : mesh.triangles())
		triangles.push_back(t[0] | uint32_t(t[1]) << 8 | uint32_t(t[2]) << 16);
	triangles = orderForReuse(triangles);
	table.configs.push_back(
		{ uint32_t(table.triangles.size()), uint32_t(table.vertices.size()), uint16_t(triangles.size()), uint16_t(mesh.points().size()) });
	for (const LatticePoint p : mesh.points())
		table.vertices.push_back(uint32_t(p.u) | uint32_t(p.v) << 16);
	table.triangles.insert(table.triangles.end(), triangles.begin(), triangles.end());
}

static TessellationTable makeTable()
{
	std::vector<std::vector<PatternMesh>> patterns;
	for (const auto& [a, b, c] : configFactors(kMaxEdgeSegments))
		patterns.push_back(searchPatterns(a, b, c, interiorRange(a, b, c)));
	const std::vector<uint32_t> chosen = spendTriangles(patterns, kTriangleBudget);
	TessellationTable table;
	for (size_t i = 0; i < patterns.size(); i++)
		appendPattern(patterns[i][chosen[i]], table);
	return table;
}

static std::string arrayText(const char* name, const std::vector<uint32_t>& numbers)
{
	std::string text = fmt::format("static constexpr uint32_t {}[] = {{", name);
	for (size_t i = 0; i < numbers.size(); i++)
		text += fmt::format("{}{:#010x},", i % 12 == 0 ? "\n\t" : " ", numbers[i]);
	return text + "\n};\n";
}

static std::string sourceText(const TessellationTable& table)
{
	std::string text = "// Made by tessera_make_table.\n#include \"tables/table.h\"\n\nnamespace tessera\n{\n\n";
	text += arrayText("kVertices", table.vertices);
	text += arrayText("kTriangles", table.triangles);
	text += "static constexpr TableConfig kConfigs[] = {\n";
	for (const TableConfig& config : table.configs)
		text += fmt::format("\t{{ {}, {}, {}, {} }},\n", config.first_triangle, config.first_vertex, config.triangle_count, config.vertex_count);
	text += "};\n\nconst TessellationTable& defaultTable()\n{\n";
	text += fmt::format("\tstatic const TessellationTable table = {{ {},\n", table.max_edge_segments);
	text += "\t\t{ std::begin(kVertices), std::end(kVertices) },\n\t\t{ std::begin(kTriangles), std::end(kTriangles) },\n"
			"\t\t{ std::begin(kConfigs), std::end(kConfigs) } };\n\treturn table;\n}\n\n}  // namespace tessera\n";
	return text;
}

static Status run(const char* path)
{
	const TessellationTable table = makeTable();
	TRY(checkTable(table));
	return writeFile(path, sourceText(table));
}

}  // namespace tessera::generate

int main(int argument_count, char** arguments)
{
	if (argument_count != 2)
	{
		fmt::print(stderr, "usage: tessera_make_table OUTPUT.cpp\n");
		return int(tessera::ExitCode::Usage);
	}
	const tessera::Status status = tessera::generate::run(arguments[1]);
	if (status)
		return 0;
	fmt::print(stderr, "error: {}\n", status.error().message);
	return int(status.error().code);
}
