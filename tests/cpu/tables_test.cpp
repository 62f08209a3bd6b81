// The tessellation table: every rule over all configs and all uses, checks that can fail, quality, table files.
#include "base/file.h"
#include "tables/lattice.h"
#include "tables/table_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace tessera
{
namespace
{

using nlohmann::json;

std::vector<LatticePoint> pointsOf(const TessellationTable& table, const TableConfig& config)
{
	std::vector<LatticePoint> points;
	for (uint32_t i = 0; i < config.vertex_count; i++)
	{
		const uint32_t packed = table.vertices[config.first_vertex + i];
		points.push_back({ int32_t(packed & 0xffff), int32_t(packed >> 16) });
	}
	return points;
}

std::vector<std::array<uint32_t, 3>> trianglesOf(const TessellationTable& table, const TableConfig& config)
{
	std::vector<std::array<uint32_t, 3>> triangles;
	for (uint32_t i = 0; i < config.triangle_count; i++)
	{
		const uint32_t packed = table.triangles[config.first_triangle + i];
		triangles.push_back({ packed & 0xff, packed >> 8 & 0xff, packed >> 16 & 0xff });
	}
	return triangles;
}

const TableConfig& configOf(const TessellationTable& table, uint32_t a, uint32_t b, uint32_t c)
{
	return table.configs[configIndex(a, b, c)];
}

// The point on the triangle's own corners of a pattern's point, as every user of PatternUse places it.
LatticePoint placed(const PatternUse& use, LatticePoint p)
{
	std::array<int32_t, 3> weights = {};
	weights[use.corner_order[0]] = p.u;
	weights[use.corner_order[1]] = p.v;
	weights[use.corner_order[2]] = p.w();
	return { weights[0], weights[1] };
}

void expectBroken(const TessellationTable& table, const std::string& config, const std::string& rule)
{
	const Status status = checkTable(table);
	ASSERT_FALSE(status) << "expected: " << rule;
	EXPECT_NE(status.error().message.find(config), std::string::npos) << status.error().message;
	EXPECT_NE(status.error().message.find(rule), std::string::npos) << status.error().message;
	EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
}

// A folder of this test's own, removed at its end.
class TableFile : public testing::Test
{
protected:
	void SetUp() override
	{
		folder_ =
			std::filesystem::path(testing::TempDir()) / (std::string("tessera_") + testing::UnitTest::GetInstance()->current_test_info()->name());
		std::filesystem::create_directories(folder_);
		path_ = folder_ / "table.json";
	}
	void TearDown() override { std::filesystem::remove_all(folder_); }

	json saved(const TessellationTable& table)
	{
		EXPECT_TRUE(saveTable(table, path_));
		const auto bytes = readFile(path_);
		const char* text = reinterpret_cast<const char*>(bytes->data());
		return json::parse(text, text + bytes->size());
	}
	Result<TessellationTable> loaded(const json& file)
	{
		EXPECT_TRUE(writeFile(path_, file.dump()));
		return loadTable(path_);
	}
	void expectRefused(const json& file, const std::string& place, const std::string& rule)
	{
		const Result<TessellationTable> table = loaded(file);
		ASSERT_FALSE(table) << "expected: " << rule;
		const std::string& message = table.error().message;
		EXPECT_EQ(table.error().code, ExitCode::BadInput);
		EXPECT_EQ(message.find(path_.string() + ": "), 0u) << message;
		EXPECT_NE(message.find(place), std::string::npos) << message;
		EXPECT_NE(message.find(rule), std::string::npos) << message;
		EXPECT_EQ(message.find('\n'), std::string::npos);
	}

	std::filesystem::path folder_;
	std::filesystem::path path_;
};

}  // namespace

TEST(table, configsAreNumberedInIncreasingOrder)
{
	EXPECT_EQ(configCount(11), 286u);
	const auto factors = configFactors(11);
	ASSERT_EQ(factors.size(), 286u);
	for (uint32_t i = 0; i < factors.size(); i++)
		EXPECT_EQ(configIndex(factors[i][0], factors[i][1], factors[i][2]), i);
	EXPECT_TRUE(std::is_sorted(factors.begin(), factors.end()));
}

TEST(table, theBuiltInTableKeepsEveryRule)
{
	const Status status = checkTable(defaultTable());
	EXPECT_TRUE(status) << status.error().message;
	EXPECT_EQ(defaultTable().configs.size(), 286u);
}

// Independent of checkTable: areas, turns, sides and rim of every triple of factors, seen from the triangle that uses the pattern.
TEST(table, everyUseCoversTheTriangleExactlyOnce)
{
	const TessellationTable& table = defaultTable();
	for (uint32_t f01 = 1; f01 <= 11; f01++)
	{
		for (uint32_t f12 = 1; f12 <= 11; f12++)
		{
			for (uint32_t f20 = 1; f20 <= 11; f20++)
			{
				SCOPED_TRACE(fmt::format("factors {} {} {}", f01, f12, f20));
				const PatternUse use = usePattern(f01, f12, f20);
				const TableConfig& config = table.configs[use.config];
				const std::vector<LatticePoint> points = pointsOf(table, config);
				std::set<std::pair<uint32_t, uint32_t>> sides;
				int64_t area = 0;
				for (auto [i, j, k] : trianglesOf(table, config))
				{
					if (use.mirror)
						std::swap(j, k);
					const int64_t one = doubledArea(placed(use, points[i]), placed(use, points[j]), placed(use, points[k]));
					ASSERT_GT(one, 0);
					area += one;
					ASSERT_TRUE(sides.insert({ i, j }).second && sides.insert({ j, k }).second && sides.insert({ k, i }).second);
				}
				ASSERT_EQ(area, int64_t(1) << 30);

				// Sides without a partner are the rim: between neighbouring points k / n of the edge they lie on.
				uint32_t rim = 0;
				for (const auto& [from, to] : sides)
				{
					if (sides.contains({ to, from }))
						continue;
					rim++;
					const LatticePoint p = placed(use, points[from]), q = placed(use, points[to]);
					const bool on01 = p.w() == 0 && q.w() == 0, on12 = p.u == 0 && q.u == 0;
					const uint32_t n = on01 ? f01 : on12 ? f12 : f20;
					const int32_t at_p = on01 ? p.v : on12 ? p.w() : p.u, at_q = on01 ? q.v : on12 ? q.w() : q.u;
					const uint32_t k = (uint32_t(at_q) * n + kBarycentricOne / 2) / kBarycentricOne;
					ASSERT_TRUE(on01 || on12 || (p.v == 0 && q.v == 0));
					ASSERT_EQ(at_p, edgeCoordinate(k - 1, n));
					ASSERT_EQ(at_q, edgeCoordinate(k, n));
				}
				ASSERT_EQ(rim, f01 + f12 + f20);
			}
		}
	}
}

TEST(table, neighboursMeetAtTheSamePointsWhateverTheyMakeOfTheRest)
{
	// The points on edge 0-1 of every triangle with that factor, measured from either end, are the same set.
	const TessellationTable& table = defaultTable();
	for (uint32_t shared = 1; shared <= 11; shared++)
	{
		std::set<std::set<int32_t>> seen;
		for (uint32_t f12 = 1; f12 <= 11; f12++)
		{
			for (uint32_t f20 = 1; f20 <= 11; f20++)
			{
				const PatternUse use = usePattern(shared, f12, f20);
				std::set<int32_t> from_zero, from_one;
				for (const LatticePoint p : pointsOf(table, table.configs[use.config]))
				{
					if (placed(use, p).w() != 0)
						continue;
					from_zero.insert(placed(use, p).v);
					from_one.insert(placed(use, p).u);
				}
				seen.insert(from_zero);
				seen.insert(from_one);
			}
		}
		EXPECT_EQ(seen.size(), 1u) << shared;
	}
}

TEST(table, usesSortTheFactorsAndMirrorOnlyWhenNoTurnDoes)
{
	for (uint32_t f01 = 1; f01 <= 11; f01++)
	{
		for (uint32_t f12 = 1; f12 <= 11; f12++)
		{
			for (uint32_t f20 = 1; f20 <= 11; f20++)
			{
				const PatternUse use = usePattern(f01, f12, f20);
				const std::array<uint8_t, 3> order = use.corner_order;
				const auto factor = [&](uint8_t i, uint8_t j) {
					return i + j == 1 ? f01 : i + j == 3 ? f12 : f20;
				};
				const uint32_t a = factor(order[0], order[1]), b = factor(order[1], order[2]), c = factor(order[2], order[0]);
				ASSERT_TRUE(a >= b && b >= c);
				ASSERT_EQ(use.config, configIndex(a, b, c));
				ASSERT_EQ(use.mirror, order[1] != (order[0] + 1) % 3);
				const bool a_turn_sorts = (f01 >= f12 && f12 >= f20) || (f12 >= f20 && f20 >= f01) || (f20 >= f01 && f01 >= f12);
				ASSERT_EQ(use.mirror, !a_turn_sorts);
			}
		}
	}
}

TEST(table, checksFindEveryBrokenRule)
{
	const TessellationTable& good = defaultTable();
	const TableConfig& config = configOf(good, 7, 6, 5);
	const std::string name = "config (7,6,5)";
	TessellationTable bad = good;
	bad.triangles[config.first_triangle + 3] = bad.triangles[config.first_triangle + 4];
	expectBroken(bad, name, "covered exactly once");

	bad = good;
	uint32_t& turned = bad.triangles[config.first_triangle + 2];
	turned = (turned & 0xff) | (turned >> 16 & 0xff) << 8 | (turned >> 8 & 0xff) << 16;
	expectBroken(bad, name, "counter-clockwise");

	bad = good;
	bad.triangles[config.first_triangle] = 0x010100;
	expectBroken(bad, name, "no area");

	bad = good;
	bad.triangles[config.first_triangle] = 0x5f0100;
	expectBroken(bad, name, "too large");

	bad = good;
	bad.triangles[config.first_triangle] |= 0x01000000;
	expectBroken(bad, name, "bits above");

	bad = good;
	bad.vertices[config.first_vertex] = 0;
	expectBroken(bad, name, "must be corner 0");

	bad = good;
	bad.vertices[config.first_vertex + 4] += 0x0000ffff;  // one unit less of u, one more of v: still on the edge
	expectBroken(bad, name, "point 2 of edge a");

	bad = good;
	bad.vertices[config.first_vertex + 4] -= 1;
	expectBroken(bad, name, "must sum to 32768");

	bad = good;
	bad.vertices[config.first_vertex + config.vertex_count - 1] = 0x00001000;
	expectBroken(bad, name, "lies on an edge");

	bad = good;
	bad.vertices[config.first_vertex + config.vertex_count - 1] = 0x60006000;
	expectBroken(bad, name, "leave the triangle");
}

TEST(table, checksFindVerticesThatNoTriangleUses)
{
	TessellationTable bad = defaultTable();
	TableConfig& config = bad.configs.back();
	config.vertex_count++;
	bad.vertices.push_back(1000 | 1000 << 16);
	expectBroken(bad, "config (11,11,11)", "vertex 78 belongs to no triangle");
}

TEST(table, checksFindBrokenLimits)
{
	const TessellationTable& good = defaultTable();
	TessellationTable bad = good;
	bad.configs[configIndex(11, 11, 11)].triangle_count = 129;
	expectBroken(bad, "config (11,11,11)", "at most 128");

	bad = good;
	bad.configs[configIndex(11, 11, 11)].vertex_count = 97;
	expectBroken(bad, "config (11,11,11)", "at most 96");

	bad = good;
	bad.configs[configIndex(2, 2, 1)].triangle_count = 5;
	expectBroken(bad, "config (2,2,1)", "at most 4");

	bad = good;
	bad.configs[configIndex(2, 1, 1)].vertex_count = 7;
	expectBroken(bad, "config (2,1,1)", "at most 6");

	bad = good;
	bad.configs[5].first_triangle = uint32_t(bad.triangles.size());
	expectBroken(bad, "config (3,2,1)", "end after");

	bad = good;
	bad.configs[5].vertex_count = 5;
	expectBroken(bad, "config (3,2,1)", "too few");

	bad = good;
	bad.configs.pop_back();
	expectBroken(bad, "285 configs", "needs 286");

	bad = good;
	bad.max_edge_segments = 12;
	expectBroken(bad, "max_edge_segments is 12", "2 to 11");
}

TEST(table, checksFindTJunctions)
{
	// (2,1,1) as one triangle that leaves out the edge point.
	TessellationTable bad = defaultTable();
	TableConfig& two = bad.configs[configIndex(2, 1, 1)];
	two.triangle_count = 1;
	bad.triangles[two.first_triangle] = 0x020100;
	expectBroken(bad, "config (2,1,1)", "side 0 to 1 has no second triangle: a T-junction");

	// (4,1,1) with vertex 6 halfway from 3 to 2, used by the triangles on one side of that line only: every area is right.
	bad = defaultTable();
	TableConfig& four = bad.configs[configIndex(4, 1, 1)];
	const uint32_t first_vertex = four.first_vertex;
	four = { uint32_t(bad.triangles.size()), uint32_t(bad.vertices.size()), 5, 7 };
	for (uint32_t i = 0; i < 6; i++)
		bad.vertices.push_back(bad.vertices[first_vertex + i]);
	bad.vertices.push_back(12288 | 4096 << 16);
	for (const uint32_t triangle : { 0x020300u, 0x060403u, 0x020406u, 0x020504u, 0x020105u })
		bad.triangles.push_back(triangle);
	expectBroken(bad, "config (4,1,1)", "T-junction");
}

TEST(table, aDiagonalFlippedInAUniformGridIsFound)
{
	TessellationTable bad = defaultTable();
	const TableConfig& config = configOf(bad, 3, 3, 3);
	const auto triangles = trianglesOf(bad, config);
	const std::vector<LatticePoint> points = pointsOf(bad, config);
	for (uint32_t s = 0; s < triangles.size(); s++)
	{
		for (uint32_t t = 0; t < triangles.size(); t++)
		{
			for (uint32_t i = 0; i < 3; i++)
			{
				for (uint32_t j = 0; j < 3; j++)
				{
					const uint32_t from = triangles[s][i], to = triangles[s][(i + 1) % 3], left = triangles[s][(i + 2) % 3];
					if (s == t || triangles[t][j] != to || triangles[t][(j + 1) % 3] != from)
						continue;
					const uint32_t right = triangles[t][(j + 2) % 3];
					if (doubledArea(points[left], points[from], points[right]) <= 0 || doubledArea(points[right], points[to], points[left]) <= 0)
						continue;
					bad.triangles[config.first_triangle + s] = left | from << 8 | right << 16;
					bad.triangles[config.first_triangle + t] = right | to << 8 | left << 16;
					expectBroken(bad, "config (3,3,3)", "uniform grid");
					return;
				}
			}
		}
	}
	FAIL() << "no diagonal to flip";
}

TEST(tableQuality, beatsThePublishedTablesAtNoMoreTriangles)
{
	const TableQuality quality = measureTable(defaultTable());
	EXPECT_LE(quality.triangle_count, 8398u);
	EXPECT_LE(quality.vertex_count, 7059u);
	EXPECT_GT(quality.mean_angle_deg, 26.0);
	EXPECT_GT(quality.median_angle_deg, 26.0);
	EXPECT_GT(quality.worst_angle.smallest_angle_deg, 4.6);
	EXPECT_LT(quality.worst_aspect.worst_aspect, 25.4);
	EXPECT_LT(quality.fetches_per_triangle, 1.0);
	for (const ConfigQuality& config : quality.configs)
	{
		EXPECT_GE(config.triangle_count, config.least_triangles);
		if (config.factors[0] == config.factors[2])
		{
			EXPECT_NEAR(config.smallest_angle_deg, 60, 0.05);
		}
	}
}

TEST(tableQuality, countsStayNearTheDensityOfTheEdges)
{
	const TessellationTable& table = defaultTable();
	const std::map<std::array<uint32_t, 3>, std::pair<uint32_t, uint32_t>> expected = {
		{ { 1, 1, 1 }, { 1, 1 } },     { { 2, 1, 1 }, { 2, 2 } },    { { 2, 2, 2 }, { 4, 4 } },       { { 5, 1, 1 }, { 5, 5 } },
		{ { 7, 3, 2 }, { 10, 12 } },   { { 11, 1, 1 }, { 11, 11 } }, { { 11, 6, 3 }, { 18, 26 } },    { { 11, 10, 9 }, { 96, 100 } },
		{ { 11, 11, 1 }, { 23, 25 } }, { { 6, 6, 4 }, { 24, 28 } },  { { 11, 11, 11 }, { 121, 121 } }
	};
	for (const auto& [f, range] : expected)
	{
		const uint32_t count = configOf(table, f[0], f[1], f[2]).triangle_count;
		EXPECT_TRUE(count >= range.first && count <= range.second) << f[0] << ' ' << f[1] << ' ' << f[2] << ": " << count;
	}
}

TEST(tableQuality, fetchesAreCountedByHand)
{
	EXPECT_EQ(countFetches({}), 0u);
	EXPECT_EQ(countFetches(std::vector<uint32_t>{ 0x020100, 0x030201 }), 4u);
	std::vector<uint32_t> far;  // 0 1 2, then 15 others, then 0 again: lost by one
	for (uint32_t i = 0; i < 6; i++)
		far.push_back(3 * i | (3 * i + 1) << 8 | (3 * i + 2) << 16);
	far.push_back(0x020100);
	EXPECT_EQ(countFetches(far), 21u);
	far = { 0x020100, 0x020100 };
	EXPECT_EQ(countFetches(far), 3u);
}

TEST(tableQuality, reportNamesTheExamplesAndTheWorst)
{
	const std::string report = qualityReport(measureTable(defaultTable()), false);
	for (const char* part : { "| configs | 286 |", "(11,6,3)", "(11,10,9)", "smallest angle, median" })
		EXPECT_NE(report.find(part), std::string::npos) << part;
}

TEST_F(TableFile, roundTripKeepsEveryNumber)
{
	const TessellationTable& table = defaultTable();
	const Result<TessellationTable> read = loaded(saved(table));
	ASSERT_TRUE(read) << read.error().message;
	EXPECT_EQ(read->max_edge_segments, 11u);
	EXPECT_EQ(read->vertices, table.vertices);
	EXPECT_EQ(read->triangles, table.triangles);
	for (size_t i = 0; i < table.configs.size(); i++)
	{
		EXPECT_EQ(read->configs[i].first_triangle, table.configs[i].first_triangle);
		EXPECT_EQ(read->configs[i].vertex_count, table.configs[i].vertex_count);
	}
}

TEST_F(TableFile, verticesInAnyOrderAreSortedAtLoad)
{
	// Reverses the vertices of every config, lists triangles and vertices as arrays and puts ranges back to front.
	const TessellationTable& table = defaultTable();
	json file = { { "max_edge_segments", 11 }, { "vertices", json::array() }, { "triangles", json::array() } };
	std::vector<json> configs;
	for (size_t c = table.configs.size(); c-- > 0;)
	{
		const TableConfig& config = table.configs[c];
		configs.push_back({ { "firstTriangle", file["triangles"].size() },
							{ "firstVertex", file["vertices"].size() },
							{ "numTriangles", config.triangle_count },
							{ "numVertices", config.vertex_count } });
		std::vector<LatticePoint> points = pointsOf(table, config);
		std::reverse(points.begin(), points.end());
		for (const LatticePoint p : points)
			file["vertices"].push_back({ p.u, p.v });
		for (const auto& [i, j, k] : trianglesOf(table, config))
			file["triangles"].push_back({ config.vertex_count - 1 - i, config.vertex_count - 1 - j, config.vertex_count - 1 - k });
	}
	std::reverse(configs.begin(), configs.end());
	file["configs"] = configs;

	const Result<TessellationTable> read = loaded(file);
	ASSERT_TRUE(read) << read.error().message;
	for (size_t c = 0; c < table.configs.size(); c++)
	{
		const auto shapes = [](const TessellationTable& t, const TableConfig& config) {
			const std::vector<LatticePoint> points = pointsOf(t, config);
			std::vector<std::array<int32_t, 6>> all;
			for (const auto& [i, j, k] : trianglesOf(t, config))
				all.push_back({ points[i].u, points[i].v, points[j].u, points[j].v, points[k].u, points[k].v });
			return all;
		};
		EXPECT_EQ(shapes(*read, read->configs[c]), shapes(table, table.configs[c])) << c;
	}
}

TEST_F(TableFile, aFileMayNameItsCornersInAnotherOrderAndRoundEitherWay)
{
	// Weights of corners 1 and 0 swapped: a mirrored file. Edge points are cut off instead of rounded.
	const TessellationTable& table = defaultTable();
	json file = saved(table);
	for (size_t c = 0; c < table.configs.size(); c++)
	{
		const TableConfig& config = table.configs[c];
		const std::array<uint32_t, 3> factors = configFactors(11)[c];
		for (uint32_t i = 0; i < config.vertex_count; i++)
		{
			LatticePoint p = pointsOf(table, config)[i];
			if (i >= 3 && i < 2 + factors[0])
			{
				const int32_t k = int32_t(i) - 2;
				p.v = k * kBarycentricOne / int32_t(factors[0]);
				p.u = kBarycentricOne - p.v;
			}
			file["vertices"][config.first_vertex + i] = { p.v, p.u };
		}
		for (uint32_t t = 0; t < config.triangle_count; t++)
		{
			const auto [i, j, k] = trianglesOf(table, config)[t];
			file["triangles"][config.first_triangle + t] = { i, k, j };
		}
	}
	const Result<TessellationTable> read = loaded(file);
	ASSERT_TRUE(read) << read.error().message;
	EXPECT_EQ(read->configs.size(), 286u);
}

TEST_F(TableFile, aSmallerTableIsAccepted)
{
	TessellationTable small = defaultTable();
	small.max_edge_segments = 4;
	small.configs.resize(configCount(4));
	small.vertices.resize(small.configs.back().first_vertex + small.configs.back().vertex_count);
	small.triangles.resize(small.configs.back().first_triangle + small.configs.back().triangle_count);
	const Result<TessellationTable> read = loaded(saved(small));
	ASSERT_TRUE(read) << read.error().message;
	EXPECT_EQ(read->max_edge_segments, 4u);
	EXPECT_EQ(read->triangles, small.triangles);
}

TEST_F(TableFile, theExampleOfTheDocumentationIsAccepted)
{
	// The same text as in docs/formats.md.
	const json file = json::parse(R"({ "max_edge_segments": 2,
	  "vertices": [[32768,0],[0,32768],[0,0],
	               [32768,0],[0,32768],[0,0],[16384,16384],
	               [32768,0],[0,32768],[0,0],[16384,16384],[0,16384],
	               [32768,0],[0,32768],[0,0],[16384,16384],[0,16384],[16384,0]],
	  "triangles": [[0,1,2], [0,3,2],[3,1,2], [0,3,2],[3,4,2],[3,1,4], [0,3,5],[3,1,4],[5,4,2],[3,4,5]],
	  "configs": [{"firstTriangle":0,"firstVertex":0, "numTriangles":1,"numVertices":3},
	              {"firstTriangle":1,"firstVertex":3, "numTriangles":2,"numVertices":4},
	              {"firstTriangle":3,"firstVertex":7, "numTriangles":3,"numVertices":5},
	              {"firstTriangle":6,"firstVertex":12,"numTriangles":4,"numVertices":6}] })");
	const Result<TessellationTable> read = loaded(file);
	ASSERT_TRUE(read) << read.error().message;
	EXPECT_EQ(read->configs.size(), 4u);
	EXPECT_EQ(read->triangles.size(), 10u);
}

TEST_F(TableFile, brokenFilesGiveOneClearLine)
{
	const TessellationTable& table = defaultTable();
	const json good = saved(table);
	const TableConfig& config = configOf(table, 5, 4, 3);

	ASSERT_TRUE(writeFile(path_, "{ \"vertices\": ["));
	const Result<TessellationTable> cut_off = loadTable(path_);
	ASSERT_FALSE(cut_off);
	EXPECT_NE(cut_off.error().message.find("no JSON"), std::string::npos);
	EXPECT_FALSE(loadTable(folder_ / "missing.json"));
	expectRefused(json::array(), "max_edge_segments", "2 to 11");

	json bad = good;
	bad["max_edge_segments"] = 12;
	expectRefused(bad, "max_edge_segments", "2 to 11");
	bad = good;
	bad["max_edge_segments"] = 10;
	expectRefused(bad, "286 configs", "needs 220");
	bad = good;
	bad.erase("vertices");
	expectRefused(bad, "\"vertices\"", "must be an array");
	bad = good;
	bad["vertices"][17] = -4;
	expectRefused(bad, "vertices[17]", "[u, v]");
	bad = good;
	bad["triangles"][3] = { 0, 1, 256 };
	expectRefused(bad, "triangles[3]", "[i, j, k]");
	bad = good;
	bad["triangles"][3] = { 0, 1 };
	expectRefused(bad, "triangles[3]", "[i, j, k]");
	bad = good;
	bad["configs"][9].erase("numVertices");
	expectRefused(bad, "configs[9]", "numVertices");
	bad = good;
	bad["configs"][9]["firstTriangle"] = 1e30;
	expectRefused(bad, "configs[9]", "firstTriangle");
	bad = good;
	bad["configs"][9]["firstTriangle"] = 4000000000u;
	expectRefused(bad, "config (3,3,3)", "triangles from 4000000000 on");
	bad = good;
	bad["vertices"][config.first_vertex + 4] = { 20000, 20000 };
	expectRefused(bad, "config (5,4,3)", "leave the triangle");
	bad = good;
	bad["vertices"][config.first_vertex + 4] = { 20000, 32768 - 20000 - 100 };
	expectRefused(bad, "config (5,4,3)", "edges have 4, 4, 3 segments, must have 5, 4, 3");
	bad = good;
	bad["vertices"][config.first_vertex + 4] = { 20000, 32768 - 20000 };
	expectRefused(bad, "config (5,4,3)", "point 2 of edge a");
	bad = good;
	bad["vertices"][config.first_vertex] = { 32767, 0 };
	expectRefused(bad, "config (5,4,3)", "");
	bad = good;
	bad["triangles"][config.first_triangle] = 0x020100;
	expectRefused(bad, "config (5,4,3)", "covered exactly once");
}

}  // namespace tessera
