// Bounds of clusters and meshes: contain everything the displaced surface reaches, and not much more.
#include "build_test_scenes.h"
#include "shared/bounds.h"

#include <gtest/gtest.h>

#include <random>

namespace tessera::test
{

namespace
{

BuiltScene built(const ImportedScene& imported, const BuildOptions& options = {})
{
	Result<BuiltScene> scene = buildScene(imported, options);
	EXPECT_TRUE(scene.has_value()) << scene.error().message;
	return std::move(*scene);
}

bool contains(const Box& box, vec3 p)
{
	return glm::all(glm::lessThanEqual(box.low, p)) && glm::all(glm::lessThanEqual(p, box.high));
}

uint32_t below(std::mt19937& random, uint32_t end)
{
	return uint32_t(random() % end);
}

DomainPoint randomPoint(std::mt19937& random)
{
	// Corners and edges too: seams are there.
	uint32_t u = below(random, DOMAIN_SIZE + 1), v = below(random, DOMAIN_SIZE + 1);
	if (u + v > DOMAIN_SIZE)
	{
		u = DOMAIN_SIZE - u;
		v = DOMAIN_SIZE - v;
	}
	switch (below(random, 8))
	{
	case 0:
		return { 0, v };
	case 1:
		return { u, 0 };
	case 2:
		return { u, DOMAIN_SIZE - u };
	case 3:
		return domainCorner(below(random, 3));
	default:
		return { u, v };
	}
}

dvec3 size(vec3 low, vec3 high)
{
	return dvec3(high) - dvec3(low);
}

double area(dvec3 s)
{
	return s.x * s.y + s.y * s.z + s.z * s.x;
}

// What sampling found of one scene at one mip setting.
struct Samples
{
	uint32_t outside_cluster = 0;
	uint32_t outside_mesh = 0;
	double tightness = 0;  // mean over clusters: area of the box over that of the points found
};

Samples sampleClusters(const BuiltScene& scene, float scale, float offset, std::mt19937& random)
{
	const HostSurface host(scene);
	const Box mesh_box = displacedBox(scene.mesh_bounds[0], scale, offset);
	Samples samples;
	for (size_t i = 0; i < scene.clusters.size(); ++i)
	{
		const Box box = displacedBox(scene.cluster_bounds[i], scale, offset);
		vec3 low(1e30f), high(-1e30f);
		for (int j = 0; j < 3000; ++j)
		{
			// A random mip each time: all must be inside.
			View view = viewFrom(vec3(0.4f, 0.3f, 2), j % 4 ? std::exp2(float(below(random, 1000)) * 0.015f - 14) : 0);
			view.displacement_scale = scale;
			view.displacement_offset = offset;
			const BaseTriangle base = baseTriangle(host.surface, scene.clusters[i], below(random, clusterTriangles(scene.clusters[i])));
			const vec3 p = surfacePoint(host.surface, base, randomPoint(random), placementFor(view), view).displaced;
			samples.outside_cluster += !contains(box, p);
			samples.outside_mesh += !contains(mesh_box, p);
			low = glm::min(low, p);
			high = glm::max(high, p);
		}
		samples.tightness += area(size(box.low, box.high)) / area(size(low, high)) / double(scene.clusters.size());
	}
	return samples;
}

}  // namespace

TEST(sceneBounds, containTheDisplacedSurfaceAtEveryMip)
{
	std::mt19937 random(1);
	for (const NamedScene& named : allScenes())
		for (const uint32_t triangles : { 4u, 64u })
			for (const bool pn : { false, true })
				for (const auto& [scale, offset] : { std::pair(1.0f, 0.0f), std::pair(-2.5f, 0.0f), std::pair(1.0f, 0.7f), std::pair(0.5f, -1.5f) })
				{
					const BuiltScene scene = built(named.scene, { .cluster_vertices = 64, .cluster_triangles = triangles, .pn = pn });
					const Samples samples = sampleClusters(scene, scale, offset, random);
					EXPECT_EQ(samples.outside_cluster, 0u) << named.name;
					EXPECT_EQ(samples.outside_mesh, 0u) << named.name;
					if (scale == 1 && offset == 0)
						printf("%-28s %2u triangles a cluster%s: box area %.2f times that of the surface\n", named.name.c_str(), triangles,
							   pn ? ", PN triangles" : "", samples.tightness);
				}
}

TEST(sceneBounds, boundingTheDisplacedCornersWouldNotBeEnough)
{
	// The octahedron's faces bulge far beyond their displaced corners: the test above would notice.
	const BuiltScene scene = built(coarseSphereScene(), { .cluster_vertices = 4, .cluster_triangles = 4 });
	const HostSurface host(scene);
	const View view = viewFrom(vec3(0, 0, 9), 0);
	const BaseTriangle base = baseTriangle(host.surface, scene.clusters[0], 0);
	const uint32_t third = DOMAIN_SIZE / 3;
	const vec3 middle = surfacePoint(host.surface, base, { third, third }, placementFor(view), view).displaced;
	vec3 sum(0);
	for (uint32_t corner = 0; corner < 3; ++corner)
		sum += surfacePoint(host.surface, base, domainCorner(corner), placementFor(view), view).displaced;
	EXPECT_GT(glm::length(middle), 1.2f * glm::length(sum / 3.0f));
}

TEST(sceneBounds, whatHeightsOfZeroLeaveInPlaceIsBoundedWhereAnOffsetMovesIt)
{
	// Black but for a texel far from every texture coordinate, which coarse mips round away: no triangle moves.
	ImportedScene imported = coarseSphereScene();
	imported.images[0] = constantImage(64, 64, TexelFormat::U8, 0);
	imported.images[0].texels[45 * 64 + 10] = std::byte(255);
	const BuiltScene scene = built(imported, { .cluster_vertices = 8, .cluster_triangles = 4 });
	std::mt19937 random(3);
	for (const float offset : { 0.0f, 0.4f, -0.3f })
	{
		const Samples samples = sampleClusters(scene, 1.5f, offset, random);
		EXPECT_EQ(samples.outside_cluster + samples.outside_mesh, 0u) << offset;
	}
	for (const DisplacedBounds& bounds : scene.cluster_bounds)
	{
		EXPECT_EQ(bounds.reach_low, 0);
		EXPECT_EQ(bounds.reach_high, 0);
		EXPECT_LT(bounds.direction_low.x, bounds.direction_high.x);
		EXPECT_EQ(displacedBox(bounds, 1.5f, 0).high, displacedBox(bounds, 1, 0).high);
	}
}

TEST(sceneBounds, undisplacedClustersHaveNoReachUnlessADisplacedNeighbourOwnsTheirEdge)
{
	const BuiltScene scene = built(halfDisplacedScene());
	for (size_t i = 0; i < scene.clusters.size(); ++i)
	{
		const DisplacedBounds& bounds = scene.cluster_bounds[i];
		const bool displaced = scene.material_height_maps[scene.clusters[i].material] != NO_INDEX;
		const bool before = bounds.high.x <= 0, after = bounds.low.x >= 1;
		if (before)
		{
			EXPECT_TRUE(bounds.reach_low == 0 && bounds.reach_high == 0);
		}
		if (after)
		{
			EXPECT_GT(bounds.reach_high, 0.4f);
		}
		if (displaced)
		{
			EXPECT_EQ(bounds.reach_low, 0.0f);  // the edge that the first sheet owns stays where it is
		}
	}
}

TEST(sceneBounds, noFrontFaceIsInAConeThatFacesAway)
{
	ImportedScene imported = sphereScene(24, 48, TexelFormat::U8, Wrap::Repeat);
	imported.materials[0].displacement.reset();
	const BuiltScene scene = built(imported);
	std::mt19937 random(2);
	std::uniform_real_distribution<float> unit(-1, 1);
	uint32_t culled = 0, facing_away = 0;
	for (int i = 0; i < 300; ++i)
	{
		const vec3 eye = vec3(unit(random), unit(random), unit(random)) * 4.0f;
		for (size_t c = 0; c < scene.clusters.size(); ++c)
		{
			const DisplacedBounds& bounds = scene.cluster_bounds[c];
			const vec3 centre = (bounds.low + bounds.high) * 0.5f;
			const float radius = glm::length(bounds.high - centre);
			const vec3 d = centre - eye;
			const bool cull = glm::dot(bounds.cone_axis, d) >= bounds.cone_cutoff * glm::length(d) + radius;
			bool front = false;
			for (uint32_t t = 0; t < clusterTriangles(scene.clusters[c]); ++t)
			{
				const uint32_t word = scene.triangles[scene.clusters[c].first_triangle + t], first = scene.clusters[c].first_vertex;
				const dvec3 p0(scene.positions[first + triangleVertex(word, 0)]), p1(scene.positions[first + triangleVertex(word, 1)]),
					p2(scene.positions[first + triangleVertex(word, 2)]);
				front = front || glm::dot(glm::cross(p1 - p0, p2 - p0), dvec3(eye) - p0) > 0;
			}
			EXPECT_FALSE(cull && front);
			culled += cull;
			facing_away += !front;
		}
	}
	printf("cones cull %u of %u clusters that face away\n", culled, facing_away);
	EXPECT_GT(culled, facing_away / 3);
}

TEST(sceneBounds, displacedAndDoubleSidedClustersAreNeverBackFacing)
{
	for (const DisplacedBounds& bounds : built(cubeScene(2)).cluster_bounds)
		EXPECT_GT(bounds.cone_cutoff, 1.0f);
	ImportedScene imported = cubeScene(2);
	imported.materials[0].displacement.reset();
	EXPECT_LT(built(imported, { .cluster_vertices = 9, .cluster_triangles = 8 }).cluster_bounds[0].cone_cutoff, 1.0f);
	imported.materials[0].double_sided = true;
	for (const DisplacedBounds& bounds : built(imported).cluster_bounds)
		EXPECT_GT(bounds.cone_cutoff, 1.0f);
}

TEST(sceneBounds, theWorldContainsEveryInstance)
{
	ImportedScene imported = coarseSphereScene();
	imported.instances[0].world[3] = dvec4(10, 0, 0, 1);
	Instance flat;
	flat.world = dmat4(0.0);
	flat.world[3] = dvec4(0, -7, 0, 1);
	imported.instances.push_back(flat);
	const BuiltScene scene = built(imported);
	EXPECT_LE(scene.world_low.y, -7);
	EXPECT_GE(scene.world_high.x, 12.5);
	EXPECT_LE(scene.world_high.x, 12.6 + 1.5);
	EXPECT_FLOAT_EQ(scene.mesh_longest_edge[0], std::sqrt(2.0f));
}

}  // namespace tessera::test
