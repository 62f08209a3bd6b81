// The built scene as a whole: watertight to the bit across every kind of seam, complete, deterministic, without what it does not need.
#include "build_test_scenes.h"

#include <gtest/gtest.h>

#include <chrono>

#include <cstring>
#include <map>

namespace tessera::test
{

namespace
{

// A triangle's edge as its neighbours know it: by welded vertices.
struct EdgeUse
{
	uint32_t cluster;
	uint32_t triangle;
	uint32_t edge;
};

using SharedEdges = std::map<std::pair<uint32_t, uint32_t>, std::vector<EdgeUse>>;

std::array<uint32_t, 3> trianglesVertices(const BuiltScene& scene, uint32_t cluster, uint32_t triangle)
{
	const ClusterRecord& record = scene.clusters[cluster];
	const uint32_t word = scene.triangles[record.first_triangle + triangle];
	return { record.first_vertex + triangleVertex(word, 0), record.first_vertex + triangleVertex(word, 1),
			 record.first_vertex + triangleVertex(word, 2) };
}

// Which triangles meet at an edge, found from positions alone (not from weld ids).
SharedEdges sharedEdges(const BuiltScene& scene)
{
	std::map<std::array<float, 3>, uint32_t> points;
	SharedEdges edges;
	for (uint32_t cluster = 0; cluster < scene.clusters.size(); ++cluster)
		for (uint32_t triangle = 0; triangle < clusterTriangles(scene.clusters[cluster]); ++triangle)
		{
			uint32_t ids[3];
			const auto vertices = trianglesVertices(scene, cluster, triangle);
			for (int i = 0; i < 3; ++i)
			{
				const vec3 p = scene.positions[vertices[size_t(i)]];
				ids[i] = points.emplace(std::array{ p.x, p.y, p.z }, uint32_t(points.size())).first->second;
			}
			for (uint32_t e = 0; e < 3; ++e)
				edges[std::minmax(ids[e], ids[(e + 1) % 3])].push_back({ cluster, triangle, e });
		}
	return edges;
}

// Counts points of shared edges, for 1 to 11 segments, that differ in a bit between the triangles that share the edge.
uint32_t countCracks(const BuiltScene& scene, const View& view)
{
	const HostSurface host(scene);
	const Placement placement = placementFor(view);
	uint32_t cracks = 0;
	for (const auto& [ends, uses] : sharedEdges(scene))
		for (uint32_t n = 1; n <= 11; ++n)
			for (uint32_t k = 0; k <= n; ++k)
			{
				if (ends.first == ends.second && k != 0 && k != n)
					continue;  // an edge of no length has one segment
				SurfacePoint first = {};
				for (size_t use = 0; use < uses.size(); ++use)
				{
					const ClusterRecord& cluster = scene.clusters[uses[use].cluster];
					const BaseTriangle base = baseTriangle(host.surface, cluster, uses[use].triangle);
					const uint32_t corners[3] = { base.v0, base.v1, base.v2 };
					const uint32_t e = uses[use].edge;
					const bool same_way =
						std::memcmp(&scene.positions[corners[e]],
									&scene.positions[trianglesVertices(scene, uses[0].cluster, uses[0].triangle)[uses[0].edge]], sizeof(vec3)) == 0;
					const DomainPoint domain =
						edgePoint(domainCorner(e), domainCorner((e + 1) % 3), same_way ? k : n - k, n, triangleEdgeFlags(base.flags));
					const SurfacePoint point = surfacePoint(host.surface, base, domain, placement, view);
					if (use == 0)
						first = point;
					cracks += std::memcmp(&first, &point, sizeof point) != 0;
				}
			}
	return cracks;
}

BuiltScene built(const ImportedScene& imported, const BuildOptions& options = {})
{
	Result<BuiltScene> scene = buildScene(imported, options);
	EXPECT_TRUE(scene.has_value()) << scene.error().message;
	return std::move(*scene);
}

const float kSamples[] = { 0, 0.003f, 0.02f, 0.1f, 0.7f, 30 };

}  // namespace

TEST(sceneBuild, trianglesThatShareAnEdgeGetTheSamePointsToTheBit)
{
	for (const NamedScene& named : allScenes())
		for (const uint32_t size : { 4u, 64u })
		{
			const BuiltScene scene = built(named.scene, { .cluster_vertices = size, .cluster_triangles = size });
			for (const float sample : kSamples)
				EXPECT_EQ(countCracks(scene, viewFrom(vec3(0.4f, 0.3f, 2), sample)), 0u) << named.name << ", sample " << sample;
		}
}

TEST(sceneBuild, withoutSeamEdgesTheSurfaceCracks)
{
	for (const ImportedScene& imported : { cubeScene(2), twoMapsScene(), halfDisplacedScene(), nonManifoldScene(), transformedScene() })
	{
		BuiltScene scene = built(imported);
		ASSERT_GT(scene.traits.seam_edges, 0u);
		for (uint32_t& triangle : scene.triangles)
			triangle &= ~(7u << 24);
		EXPECT_GT(countCracks(scene, viewFrom(vec3(0.4f, 0.3f, 2), 0.01f)), 0u);
	}
}

TEST(sceneBuild, withoutSeamCornersTheSurfaceCracks)
{
	for (const ImportedScene& imported : { cubeScene(2), twoMapsScene(), halfDisplacedScene(), nonManifoldScene(), transformedScene() })
	{
		BuiltScene scene = built(imported);
		ASSERT_GT(scene.traits.seam_corners, 0u);
		scene.seam_corner_indices.assign(scene.positions.size(), NO_INDEX);
		EXPECT_GT(countCracks(scene, viewFrom(vec3(0.4f, 0.3f, 2), 0.01f)), 0u);
	}
}

TEST(sceneBuild, aVertexIsTheCornerOfEveryTriangleOfItToTheBit)
{
	for (const NamedScene& named : allScenes())
	{
		const BuiltScene scene = built(named.scene);
		const HostSurface host(scene);
		const View view = viewFrom(vec3(0.4f, 0.3f, 2), 0.02f);
		const Placement placement = placementFor(view);
		for (const ClusterRecord& cluster : scene.clusters)
			for (uint32_t t = 0; t < clusterTriangles(cluster); ++t)
			{
				const BaseTriangle base = baseTriangle(host.surface, cluster, t);
				const uint32_t corners[3] = { base.v0, base.v1, base.v2 };
				for (uint32_t corner = 0; corner < 3; ++corner)
				{
					const SurfacePoint inside = surfacePoint(host.surface, base, domainCorner(corner), placement, view);
					const SurfacePoint alone = surfaceVertex(host.surface, corners[corner], base.height_map, placement, view);
					EXPECT_EQ(std::memcmp(&inside, &alone, sizeof alone), 0) << named.name;
				}
			}
	}
}

TEST(sceneBuild, everyInputTriangleAppearsOnceWithItsCorners)
{
	for (const NamedScene& named : allScenes())
	{
		const BuiltScene scene = built(named.scene, { .cluster_vertices = 16, .cluster_triangles = 16 });
		std::vector<vec3> corners;
		for (const Primitive& primitive : named.scene.meshes[0].primitives)
			for (const uint32_t index : primitive.indices)
				corners.push_back(primitive.positions[index]);
		std::vector<int> seen(corners.size() / 3, 0);
		for (uint32_t cluster = 0; cluster < scene.clusters.size(); ++cluster)
			for (uint32_t t = 0; t < clusterTriangles(scene.clusters[cluster]); ++t)
			{
				const uint32_t source = scene.source_triangles[scene.clusters[cluster].first_triangle + t];
				ASSERT_LT(source, seen.size());
				++seen[source];
				const auto vertices = trianglesVertices(scene, cluster, t);
				for (size_t i = 0; i < 3; ++i)
					EXPECT_EQ(scene.positions[vertices[i]], corners[3 * source + i]) << named.name;
			}
		EXPECT_EQ(std::vector<int>(seen.size(), 1), seen) << named.name;
	}
}

TEST(sceneBuild, clustersAndMeshesCoverTheArraysWithoutGaps)
{
	for (const NamedScene& named : allScenes())
	{
		const BuiltScene scene = built(named.scene, { .cluster_vertices = 20, .cluster_triangles = 12 });
		uint32_t next_vertex = 0, next_triangle = 0;
		for (const ClusterRecord& cluster : scene.clusters)
		{
			EXPECT_EQ(cluster.first_vertex, next_vertex);
			EXPECT_EQ(cluster.first_triangle, next_triangle);
			EXPECT_LE(clusterVertices(cluster), 20u);
			EXPECT_LE(clusterTriangles(cluster), 12u);
			next_vertex += clusterVertices(cluster);
			next_triangle += clusterTriangles(cluster);
		}
		EXPECT_EQ(next_vertex, scene.positions.size());
		EXPECT_EQ(next_triangle, scene.triangles.size());
		EXPECT_EQ(scene.cluster_bounds.size(), scene.clusters.size());
	}
}

TEST(sceneBuild, theSameInputGivesTheSameBytes)
{
	for (const NamedScene& named : allScenes())
	{
		const BuiltScene a = built(named.scene), b = built(named.scene);
		EXPECT_EQ(a.triangles, b.triangles);
		EXPECT_EQ(a.positions, b.positions);
		EXPECT_EQ(std::memcmp(a.cluster_bounds.data(), b.cluster_bounds.data(), a.cluster_bounds.size() * sizeof(DisplacedBounds)), 0);
	}
}

TEST(sceneBuild, edgeFlagsFollowWeldIdsAndDirectionsAreEqualWithinAWeldId)
{
	for (const NamedScene& named : allScenes())
	{
		const BuiltScene scene = built(named.scene);
		std::map<uint32_t, vec3> directions;
		for (uint32_t v = 0; v < scene.positions.size(); ++v)
		{
			const vec3 first = directions.emplace(scene.weld_ids[v], scene.directions[v]).first->second;
			EXPECT_EQ(std::memcmp(&first, &scene.directions[v], sizeof first), 0) << named.name;
		}
		for (uint32_t cluster = 0; cluster < scene.clusters.size(); ++cluster)
			for (uint32_t t = 0; t < clusterTriangles(scene.clusters[cluster]); ++t)
			{
				const auto vertices = trianglesVertices(scene, cluster, t);
				const uint32_t flags = triangleEdgeFlags(scene.triangles[scene.clusters[cluster].first_triangle + t]);
				for (size_t e = 0; e < 3; ++e)
					EXPECT_EQ((flags >> e & 1) != 0, scene.weld_ids[vertices[e]] < scene.weld_ids[vertices[(e + 1) % 3]]);
			}
	}
}

TEST(sceneBuild, sheetsThatTouchInAPointKeepTheirOwnDirections)
{
	const BuiltScene scene = built(touchingConesScene());
	bool up = false, down = false;
	for (uint32_t v = 0; v < scene.positions.size(); ++v)
		if (scene.positions[v] == vec3(0))
		{
			up = up || scene.directions[v] == vec3(0, 0, 1);
			down = down || scene.directions[v] == vec3(0, 0, -1);
		}
	EXPECT_TRUE(up && down);
	EXPECT_EQ(scene.traits.zero_directions, 0u);
}

TEST(sceneBuild, normalsThatCancelOutAreCountedAndNotDisplaced)
{
	ImportedScene imported;
	Primitive p;
	p.material = addDisplaced(imported, noiseImage(8, 8, TexelFormat::U8, 1), 1, 0);
	const vec3 points[3] = { vec3(0), vec3(1, 0, 0), vec3(0, 1, 0) };
	for (const float z : { 1.0f, -1.0f })
		for (const vec3 point : points)
			addVertex(p, point, vec3(0, 0, z), vec2(point));
	addTriangle(p, 0, 1, 2);
	addTriangle(p, 3, 5, 4);
	addPlacedMesh(imported, { p });
	const BuiltScene scene = built(imported);
	EXPECT_EQ(scene.traits.zero_directions, 3u);
	EXPECT_EQ(scene.directions, std::vector<vec3>(6, vec3(0)));
	EXPECT_EQ(scene.warnings.size(), 1u);
}

TEST(sceneBuild, missingNormalsAreSmoothOverTheFan)
{
	ImportedScene imported = sphereScene(16, 32, TexelFormat::U8, Wrap::Repeat);
	imported.meshes[0].primitives[0].normals.clear();
	const BuiltScene scene = built(imported);
	for (uint32_t v = 0; v < scene.positions.size(); ++v)
		EXPECT_GT(glm::dot(scene.normals[v], scene.positions[v]), 0.99f);
	EXPECT_TRUE(scene.traits.directions_are_normals);
	EXPECT_EQ(scene.traits.boundary_edges, 0u);
}

TEST(sceneBuild, smoothAuthoredNormalsAreTheDirections)
{
	const BuiltScene sphere = built(sphereScene(8, 16, TexelFormat::U8, Wrap::Repeat));
	EXPECT_TRUE(sphere.traits.directions_are_normals);
	EXPECT_FALSE(built(cubeScene(1)).traits.directions_are_normals);
}

TEST(sceneBuild, whatTheSceneDoesNotNeedIsEmpty)
{
	ImportedScene imported = cubeScene(1);
	imported.materials[0].displacement.reset();
	const BuiltScene scene = built(imported);
	EXPECT_TRUE(scene.directions.empty() && scene.uvs.empty() && scene.densities.empty() && scene.height_maps.empty());
	EXPECT_TRUE(scene.seam_edges.empty() && scene.seam_corners.empty() && scene.first_seam_edges.empty() && scene.seam_corner_indices.empty());
	EXPECT_TRUE(scene.colors.empty() && scene.color_uvs.empty() && scene.color_textures.empty());
	EXPECT_FALSE(scene.traits.has_displacement);
	EXPECT_EQ(scene.cluster_bounds[0].reach_low, 0.0f);
	EXPECT_EQ(scene.cluster_bounds[0].reach_high, 0.0f);
}

TEST(sceneBuild, aDisplacementOfNothingIsNone)
{
	for (const TexelFormat format : { TexelFormat::U8, TexelFormat::U16, TexelFormat::F32 })
	{
		ImportedScene zero_map = cubeScene(1), zero_factor = cubeScene(1);
		zero_map.images[0] = constantImage(8, 8, format, 0);
		zero_map.materials[0].displacement->offset = 0;
		zero_factor.materials[0].displacement->factor = 0;
		zero_factor.materials[0].displacement->offset = 0;
		EXPECT_FALSE(built(zero_map).traits.has_displacement);
		EXPECT_FALSE(built(zero_factor).traits.has_displacement);
		zero_map.materials[0].displacement->offset = 0.5f;
		EXPECT_TRUE(built(zero_map).traits.has_displacement);
	}
}

TEST(sceneBuild, aPrimitiveWithoutTheCoordinatesIsDrawnUndisplacedWithAWarning)
{
	ImportedScene imported = twoMapsScene();
	imported.materials[1].displacement = imported.materials[0].displacement;
	imported.meshes[0].primitives[1].material = 0;
	imported.meshes[0].primitives[1].texcoords.clear();
	const BuiltScene scene = built(imported);
	ASSERT_EQ(scene.warnings.size(), 1u);
	EXPECT_NE(scene.warnings[0].find("TEXCOORD_0"), std::string::npos);
	EXPECT_EQ(scene.materials.size(), 3u);
	EXPECT_EQ(scene.material_height_maps[2], NO_INDEX);
	EXPECT_EQ(scene.height_maps.size(), 1u);
	EXPECT_EQ(countCracks(scene, viewFrom(vec3(0, 0, 2), 0.01f)), 0u);
}

TEST(sceneBuild, meshesThatNothingPlacesAreLeftOut)
{
	ImportedScene imported = cubeScene(2);
	imported.meshes.push_back(imported.meshes[0]);
	const BuiltScene scene = built(imported);
	ASSERT_EQ(scene.meshes.size(), 2u);
	EXPECT_GT(scene.meshes[0].cluster_count, 0u);
	EXPECT_EQ(scene.meshes[1].cluster_count, 0u);
	EXPECT_EQ(scene.traits.base_triangles, 48u);
}

TEST(sceneBuild, clusterSizesOutOfRangeAreRefused)
{
	for (const BuildOptions options : { BuildOptions{ 129, 64 }, BuildOptions{ 64, 130 }, BuildOptions{ 64, 66 }, BuildOptions{ 2, 64 } })
	{
		const Result<BuiltScene> scene = buildScene(cubeScene(1), options);
		ASSERT_FALSE(scene.has_value());
		EXPECT_EQ(scene.error().code, ExitCode::Usage);
	}
}

// meshoptimizer leaves out triangles whose distances overflow in float.
TEST(sceneBuild, everyTriangleIsKeptAtEveryScale)
{
	for (int exponent = -55; exponent <= 58; exponent += 1 + (exponent >= -20 && exponent < 20))
	{
		ImportedScene imported = cubeScene(3);
		for (vec3& p : imported.meshes[0].primitives[0].positions)
			p *= std::ldexp(1.0f, exponent);
		imported.materials[0].displacement.reset();
		const Result<BuiltScene> scene = buildScene(imported);
		ASSERT_TRUE(scene.has_value()) << scene.error().message;
		EXPECT_EQ(scene->traits.base_triangles, 108u) << "2^" << exponent;
	}
}

TEST(sceneBuild, whatReachesBeyondTheSquaresOfFloatsIsRefused)
{
	ImportedScene far = cubeScene(1), tall = cubeScene(1), wide = cubeScene(1);
	far.instances[0].world[3] = dvec4(1e19, 0, 0, 1);
	tall.materials[0].displacement->factor = 1e30f;
	wide.meshes[0].primitives[0].positions[0].x = 1e25f;
	for (const ImportedScene& imported : { far, tall, wide })
	{
		const Result<BuiltScene> scene = buildScene(imported);
		ASSERT_FALSE(scene.has_value());
		EXPECT_EQ(scene.error().code, ExitCode::BadInput);
		EXPECT_NE(scene.error().message.find("2^60"), std::string::npos) << scene.error().message;
	}
}

// Triangles around one vertex once took a time that grew with their number's square: minutes for these.
TEST(sceneBuild, aVertexOfVeryManyTrianglesIsNoSlower)
{
	constexpr uint32_t kSpokes = 200'000;
	ImportedScene imported;
	Primitive fan;
	fan.material = addPlain(imported, "plain");
	addVertex(fan, vec3(0), vec3(0, 0, 1), vec2(0));
	for (uint32_t i = 0; i < kSpokes; ++i)
	{
		const float angle = 6.2831853f * float(i) / kSpokes;
		addVertex(fan, vec3(std::cos(angle), std::sin(angle), 0), vec3(0, 0, 1), vec2(0));
	}
	for (uint32_t i = 0; i < kSpokes; ++i)
		addTriangle(fan, 0, 1 + i, 1 + (i + 1) % kSpokes);
	addPlacedMesh(imported, { fan });
	const auto start = std::chrono::steady_clock::now();
	EXPECT_EQ(built(imported).traits.base_triangles, kSpokes);
	EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

}  // namespace tessera::test
