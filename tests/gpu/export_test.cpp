// `tessera export`: the written files, read by code of this test alone, are watertight and hold what a frame draws.
#include "cpu/program_run.h"
#include "scene/gltf_import.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace tessera::test
{

namespace
{

using nlohmann::json;
using Point = std::array<uint32_t, 3>;  // bits of a position

class exportedMesh : public testing::Test
{
protected:
	void SetUp() override
	{
		const ProgramRun run = runTessera("info");
		if (run.exit_code == 4)
			GTEST_SKIP() << run.errors;
	}
};

// A binary PLY file of floats and uint triangles: what its header says, no more.
struct PlyFile
{
	std::vector<std::vector<float>> vertices;
	std::vector<std::array<uint32_t, 3>> triangles;
};

PlyFile readPlyFile(const std::string& name)
{
	std::ifstream file(scratchFolder() / name, std::ios::binary);
	PlyFile ply;
	std::string line;
	size_t vertex_count = 0, face_count = 0, properties = 0;
	while (std::getline(file, line) && line != "end_header")
	{
		std::istringstream words(line);
		std::string first, second;
		words >> first >> second;
		if (first == "element")
			words >> (second == "vertex" ? vertex_count : face_count);
		properties += first == "property" && second == "float";
	}
	for (size_t i = 0; i < vertex_count; ++i)
	{
		std::vector<float> values(properties);
		file.read(reinterpret_cast<char*>(values.data()), std::streamsize(properties * 4));
		ply.vertices.push_back(values);
	}
	for (size_t i = 0; i < face_count; ++i)
	{
		char corners = 0;
		std::array<uint32_t, 3> triangle = {};
		file.read(&corners, 1);
		EXPECT_EQ(corners, 3);
		file.read(reinterpret_cast<char*>(triangle.data()), 12);
		ply.triangles.push_back(triangle);
	}
	EXPECT_TRUE(file.good()) << name << " ends early";
	return ply;
}

Point pointOf(const std::vector<float>& vertex)
{
	Point point;
	std::memcpy(point.data(), vertex.data(), 12);
	return point;
}

// Edges between equal positions: how often each is walked from the smaller end to the larger, less how often back.
struct Edges
{
	std::map<std::pair<Point, Point>, std::array<int, 2>> uses;  // forward, backward
	std::set<Point> points;
	size_t triangles = 0;

	explicit Edges(const PlyFile& ply)
	{
		for (const auto& triangle : ply.triangles)
		{
			std::array<Point, 3> p;
			for (size_t i = 0; i < 3; ++i)
				p[i] = pointOf(ply.vertices.at(triangle[i]));
			if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0])
				continue;
			++triangles;
			points.insert(p.begin(), p.end());
			for (size_t i = 0; i < 3; ++i)
			{
				const Point &from = p[i], &to = p[(i + 1) % 3];
				++uses[std::minmax(from, to)][from < to ? 0 : 1];
			}
		}
	}

	size_t open() const
	{
		return size_t(std::count_if(uses.begin(), uses.end(), [](const auto& edge) { return edge.second[0] != edge.second[1]; }));
	}
	// Used by other than two triangles, one each way.
	size_t unusual() const
	{
		return size_t(std::count_if(uses.begin(), uses.end(), [](const auto& edge) { return edge.second != std::array{ 1, 1 }; }));
	}
	// Vertices - edges + faces: 2 for a sphere.
	long euler() const { return long(points.size()) - long(uses.size()) + long(triangles); }
};

PlyFile exported(const std::string& arguments, const std::string& name = "mesh.ply")
{
	const ProgramRun run = runTessera("export " + arguments + " --quiet -o " + name);
	EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.errors;
	return readPlyFile(name);
}

// The raster paths that this device has.
std::vector<std::string> paths()
{
	std::vector<std::string> names;
	for (const char* name : { "soft", "mesh", "indexed" })
		if (runTessera(std::string("export builtin:quad --quiet -o path.ply --raster ") + name).exit_code == 0)
			names.emplace_back(name);
	return names;
}

size_t microTriangles(const std::string& arguments)
{
	const ProgramRun run = runTessera("render " + arguments + " --cull off --stats - --quiet");
	return json::parse(run.output, nullptr, false)["frame"]["micro_triangles"].get<size_t>();
}

std::multiset<std::array<Point, 3>> trianglesOf(const PlyFile& ply)
{
	std::multiset<std::array<Point, 3>> triangles;
	for (const auto& t : ply.triangles)
	{
		std::array<Point, 3> p = { pointOf(ply.vertices[t[0]]), pointOf(ply.vertices[t[1]]), pointOf(ply.vertices[t[2]]) };
		std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
		triangles.insert(p);
	}
	return triangles;
}

}  // namespace

TEST_F(exportedMesh, isASphereWhereTheSceneIsOneForEveryRasterPath)
{
	std::multiset<std::array<Point, 3>> first;
	for (const std::string& path : paths())
	{
		const PlyFile ply = exported("builtin:planet --size 320x180 --rate 4 --raster " + path);
		const Edges edges(ply);
		EXPECT_GT(edges.triangles, 8000u) << path;
		EXPECT_EQ(edges.open(), 0u) << path;
		EXPECT_EQ(edges.unusual(), 0u) << path;
		EXPECT_EQ(edges.euler(), 2) << path;
		if (first.empty())
			first = trianglesOf(ply);
		EXPECT_TRUE(first == trianglesOf(ply)) << path << " draws other triangles";
	}
}

TEST_F(exportedMesh, isClosedAcrossHardEdgesSeamsAndSplits)
{
	// From close by: the nearest triangles are split, the farthest are full clusters.
	const PlyFile ply = exported("builtin:cube --size 320x180 --rate 3 --eye 0.9,0.8,1.1");
	const Edges edges(ply);
	EXPECT_GT(edges.triangles, 1000u);
	EXPECT_EQ(edges.open(), 0u);
	EXPECT_EQ(edges.euler(), 2);
}

TEST_F(exportedMesh, aMissingOrMovedTriangleIsSeen)
{
	PlyFile ply = exported("builtin:cube --size 160x90 --rate 8");
	ASSERT_EQ(Edges(ply).open(), 0u);
	PlyFile cracked = ply;
	cracked.vertices.push_back(ply.vertices[ply.triangles[5][0]]);
	cracked.vertices.back()[1] += 1e-6f;
	cracked.triangles[5][0] = uint32_t(ply.vertices.size());
	EXPECT_GT(Edges(cracked).open(), 0u);
	ply.triangles.pop_back();
	EXPECT_EQ(Edges(ply).open(), 3u);
}

TEST_F(exportedMesh, holdsEveryMicroTriangleOfTheFrameAndLessWithCulling)
{
	const std::string arguments = "builtin:bricks --size 160x90 --rate 6";
	const size_t all = exported(arguments).triangles.size();
	EXPECT_EQ(all, microTriangles(arguments));
	const std::string close = arguments + " --fov 10";
	EXPECT_LT(exported(close + " --cull on").triangles.size(), exported(close).triangles.size());
}

TEST_F(exportedMesh, hasUnitNormalsAndWeldsSmoothEdges)
{
	const PlyFile ply = exported("builtin:planet --size 160x90 --rate 8");
	const Edges edges(ply);
	for (const auto& vertex : ply.vertices)
	{
		const double length =
			std::sqrt(double(vertex[3]) * double(vertex[3]) + double(vertex[4]) * double(vertex[4]) + double(vertex[5]) * double(vertex[5]));
		ASSERT_NEAR(length, 1, 1e-5);
	}
	// Few places have two vertices: texture seams, and where neighbours' height gradients differ.
	EXPECT_LT(ply.vertices.size(), edges.points.size() * 3 / 2);
}

TEST_F(exportedMesh, placesMirroredAndManyInstancesOutwardsInTheWorld)
{
	const PlyFile ply = exported("builtin:cube --grid 2x1 --grid-u 10,0,0 --size 160x90 --rate 8");
	float low = 1e9f, high = -1e9f;
	double volume = 0;
	for (const auto& t : ply.triangles)
	{
		const auto at = [&](size_t corner, size_t axis) {
			return double(ply.vertices[t[corner]][axis]);
		};
		volume += at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) - at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
				  at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
	}
	for (const auto& vertex : ply.vertices)
	{
		low = std::min(low, vertex[0]);
		high = std::max(high, vertex[0]);
	}
	EXPECT_GT(high - low, 10.0f);
	EXPECT_GT(volume, 0);
	EXPECT_EQ(Edges(ply).open(), 0u);
}

TEST_F(exportedMesh, glbHoldsTheSameAsPly)
{
	const std::string arguments = "builtin:quad --size 160x90 --rate 8";
	const PlyFile ply = exported(arguments);
	ASSERT_EQ(runTessera("export " + arguments + " --quiet -o mesh.glb").exit_code, 0);
	const Result<ImportedScene> glb = importGltf(scratchFolder() / "mesh.glb");
	ASSERT_TRUE(glb.has_value()) << glb.error().message;
	const Primitive& mesh = glb->meshes.at(0).primitives.at(0);
	EXPECT_EQ(mesh.indices.size(), ply.triangles.size() * 3);
	EXPECT_EQ(mesh.positions.size(), ply.vertices.size());
	EXPECT_EQ(mesh.normals.size(), ply.vertices.size());
	EXPECT_EQ(mesh.texcoords.size(), 1u);
}

TEST_F(exportedMesh, aCoarserFrameIsRefusedByStrictAndRoundsLoseNothing)
{
	const std::string tight = "builtin:quad --size 96x64 --rate 0.5 --capacity part_triangles=20";
	EXPECT_EQ(runTessera("export " + tight + " --strict -o strict.ply").exit_code, 5);
	EXPECT_FALSE(std::filesystem::exists(scratchFolder() / "strict.ply"));
	const std::string many = "builtin:planet --grid 6x6 --size 96x64 --rate 20";
	EXPECT_TRUE(trianglesOf(exported(many)) == trianglesOf(exported(many + " --capacity visible_clusters=512")));
}

}  // namespace tessera::test
