// PN triangles (shared/pn.h): the same from both sides of every edge, within their bounds, flat where they should be, and nearer to smooth shapes.
#include "reference_test_scenes.h"

#include "reference/cover.h"
#include "reference/double_surface.h"
#include "reference/evaluate.h"
#include "reference/watertight.h"
#include "scene/build/pn_patch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace tessera::test
{

namespace
{

using reference::Classified;
using reference::WatertightReport;

constexpr BuildOptions kPn = { .pn = true };

struct Random
{
	std::mt19937 bits{ 7 };

	uint32_t below(uint32_t n) { return uint32_t(bits() % n); }
	DomainPoint domain()
	{
		const uint32_t u = below(DOMAIN_SIZE + 1);
		return { u, below(DOMAIN_SIZE - u + 1) };
	}
};

// Every scene as it is and without displacement.
std::vector<NamedScene> scenesWithAndWithoutDisplacement()
{
	std::vector<NamedScene> scenes = allScenes();
	for (NamedScene plain : allScenes())
	{
		plain.name += ", not displaced";
		for (Material& material : plain.scene.materials)
			material.displacement.reset();
		scenes.push_back(std::move(plain));
	}
	scenes.push_back({ "round", roundScene(2) });
	return scenes;
}

WatertightReport watertightOf(const ReferenceScene& scene, const View& view)
{
	const Classified result = classifyAll(scene, view);
	return checkWatertight(scene.host, view, result.full_clusters, result.parts);
}

// body(cluster, triangle) for every base triangle of the first instance.
template <typename Body>
void forEachTriangle(const ReferenceScene& scene, const Body& body)
{
	for (uint32_t c = 0; c < scene.built.clusters.size(); ++c)
		for (uint32_t t = 0; t < clusterTriangles(scene.built.clusters[c]); ++t)
			body(ClusterRef{ 0, c }, t);
}

bool sameBits(vec3 a, vec3 b)
{
	return std::memcmp(&a, &b, sizeof a) == 0;
}

// Largest distance from the unit sphere over the micro-vertices of a frame, and over the middles of its micro-triangles.
struct RoundError
{
	double vertices = 0, middles = 0;
	uint64_t triangles = 0;
};

RoundError roundError(uint32_t cuts, bool pn, double rate)
{
	const ReferenceScene scene(roundScene(cuts), defaultTable(), { .pn = pn });
	EXPECT_EQ(scene.built.traits.has_pn, pn);
	const View view = viewOf(scene, cameraAt(dvec3(0, 0, 4), dvec3(0)), request(400, rate));
	RoundError error;
	for (const reference::ReferencePiece& part : classifyAll(scene, view).parts)
	{
		const reference::Evaluated mesh = reference::evaluatePart(scene.host, view, part);
		for (const reference::MicroVertex& vertex : mesh.vertices)
			error.vertices = std::max(error.vertices, std::abs(glm::length(dvec3(vertex.displaced)) - 1));
		for (const uvec3 t : mesh.triangles)
		{
			const dvec3 middle = dvec3(mesh.vertices[t.x].displaced) + dvec3(mesh.vertices[t.y].displaced) + dvec3(mesh.vertices[t.z].displaced);
			error.middles = std::max(error.middles, std::abs(glm::length(middle) / 3 - 1));
		}
		error.triangles += mesh.triangles.size();
	}
	return error;
}

}  // namespace

// --- shared edges ----------------------------------------------------------------------------------------------------------------

TEST(pnTriangles, trianglesThatShareAnEdgeGetTheSamePointsToTheBit)
{
	uint64_t points = 0;
	for (const NamedScene& named : scenesWithAndWithoutDisplacement())
		for (const uint32_t triangles : { 4u, 64u })
		{
			const ReferenceScene scene(named.scene, defaultTable(), { .cluster_triangles = triangles, .pn = true });
			for (const double rate : { 40.0, 5.0 })
			{
				const WatertightReport report = watertightOf(scene, viewOf(scene, framingCamera(scene.built), request(300, rate)));
				EXPECT_TRUE(report.holds()) << named.name << ": " << report.first_problem;
				points += report.points;
			}
		}
	EXPECT_GT(points, 50'000u);
}

TEST(pnTriangles, normalsOfOneSideInsteadOfWeldedDirectionsWouldCrackHardEdges)
{
	ImportedScene imported = cubeScene(2);
	imported.materials[0].displacement.reset();
	BuiltScene built = ReferenceScene(imported, defaultTable(), kPn).built;
	built.directions = built.normals;
	// The faces' own normals are those of their planes: bend them so that there is something to see.
	for (size_t v = 0; v < built.directions.size(); ++v)
		built.directions[v] = glm::normalize(built.normals[v] + 0.5f * glm::normalize(built.positions[v]));
	const reference::HostScene host(built, defaultTable());
	const Camera camera = framingCamera(built);
	const Result<View> view = makeView(camera, built, request(300, 10));
	ASSERT_TRUE(view.has_value());
	const Classified result = reference::classify(host, *view, { 11, 8 }, reference::allClusters(host));
	EXPECT_GT(checkWatertight(host, *view, result.full_clusters, result.parts).differing_edges, 10u);
}

TEST(pnTriangles, anEdgeIsTheSameWhicheverCornersItHasAndWhateverLiesBeside)
{
	Random random;
	std::uniform_real_distribution<float> real(-3, 3);
	const auto point = [&] {
		return vec3(real(random.bits), real(random.bits), real(random.bits));
	};
	for (int i = 0; i < 20000; ++i)
	{
		const vec3 ends[2] = { point(), point() }, directions[2] = { normalized(point()), i % 7 ? normalized(point()) : vec3(0) };
		const uint32_t along = random.below(DOMAIN_SIZE + 1);
		vec3 first(0);
		for (uint32_t turn = 0; turn < 6; ++turn)
		{
			// Corner of the first end, that of the second, and someone else's.
			const uint32_t a = turn % 3, b = (a + (turn < 3 ? 1 : 2)) % 3, c = 3 - a - b;
			vec3 p[3], n[3], weights(0);
			p[a] = ends[0], p[b] = ends[1], p[c] = point();
			n[a] = directions[0], n[b] = directions[1], n[c] = normalized(point());
			weights[int(a)] = float(DOMAIN_SIZE - along) / float(DOMAIN_SIZE);
			weights[int(b)] = float(along) / float(DOMAIN_SIZE);
			const vec3 flat = weightedVec3(p[0], p[1], p[2], weights);
			const vec3 curved = pnPoint(flat, pnRises(p[0], p[1], p[2], n[0], n[1], n[2]), n[0], n[1], n[2], weights);
			if (turn == 0)
				first = curved;
			ASSERT_TRUE(sameBits(curved, first)) << i << " " << turn;
		}
	}
}

TEST(pnTriangles, cornersStayWhereTheyAreToTheBit)
{
	for (const NamedScene& named : scenesWithAndWithoutDisplacement())
	{
		const ReferenceScene scene(named.scene, defaultTable(), kPn);
		forEachTriangle(scene, [&](ClusterRef ref, uint32_t t) {
			const BaseTriangle base = scene.host.base(ref, t);
			const uint32_t vertices[3] = { base.v0, base.v1, base.v2 };
			for (uint32_t corner = 0; corner < 3; ++corner)
				ASSERT_TRUE(sameBits(sampleAtPoint(scene.host.surface(), base, domainCorner(corner)).base, scene.built.positions[vertices[corner]]))
					<< named.name;
		});
	}
}

// --- what the surface is ---------------------------------------------------------------------------------------------------------

TEST(pnTriangles, floatPointsLieWithinTheirBoundOfThePapersControlPoints)
{
	Random random;
	double largest_share = 0;
	for (const NamedScene& named : scenesWithAndWithoutDisplacement())
	{
		const ReferenceScene scene(named.scene, defaultTable(), kPn);
		const View view = viewOf(scene, framingCamera(scene.built), request(300, 5));
		const reference::DoubleSurface exact(scene.host, view);
		forEachTriangle(scene, [&](ClusterRef ref, uint32_t t) {
			for (int i = 0; i < 20; ++i)
			{
				const DomainPoint p = random.domain();
				const reference::DoublePoint expected = exact.at(ref, t, p);
				const reference::MicroVertex found = reference::evaluatePoint(scene.host, view, ref, t, p);
				const dvec3 base = glm::abs(dvec3(found.base) - expected.base), displaced = glm::abs(dvec3(found.displaced) - expected.displaced);
				const double base_error = std::max({ base.x, base.y, base.z });
				ASSERT_LE(base_error, expected.base_bound) << named.name;
				ASSERT_LE(std::max({ displaced.x, displaced.y, displaced.z }), expected.displaced_bound) << named.name;
				largest_share = std::max(largest_share, base_error / expected.base_bound);
			}
		});
	}
	printf("largest error of a base position / bound: %.2f\n", largest_share);
	EXPECT_GT(largest_share, 0.02);
}

TEST(pnTriangles, aCoarseSphereComesMuchNearerToTheTrueOneAtEqualTriangles)
{
	// Edges of the octahedron turn by a right angle: too much for a cubic. The finer the model the larger the gain.
	for (const auto& [cuts, gain] : { std::pair(1u, 1.5), std::pair(2u, 3.5), std::pair(3u, 8.0), std::pair(4u, 10.0), std::pair(8u, 20.0) })
	{
		const RoundError flat = roundError(cuts, false, 2), curved = roundError(cuts, true, 2);
		printf("sphere of %3u base triangles, %llu micro-triangles: flat %.5f, PN triangles %.5f of the radius\n", 8 * cuts * cuts,
			   static_cast<unsigned long long>(flat.triangles), flat.middles, curved.middles);
		EXPECT_EQ(flat.triangles, curved.triangles);
		EXPECT_LT(curved.vertices * gain, flat.vertices) << cuts;
		EXPECT_LT(curved.middles * gain, flat.middles) << cuts;
	}
}

TEST(pnTriangles, aFlatSurfaceStaysFlatAndNeedsNothing)
{
	// Along the axes every rise is 0: nothing is kept for PN triangles.
	const vec3 corners[4] = { vec3(0.3f, 0.1f, 2), vec3(1.7f, -0.2f, 2), vec3(1.1f, 1.3f, 2), vec3(-0.4f, 0.9f, 2) };
	const ReferenceScene level(triangleScene({ corners[0], corners[1], corners[2], corners[0], corners[2], corners[3] }), defaultTable(), kPn);
	EXPECT_FALSE(level.built.traits.has_pn);
	EXPECT_TRUE(level.built.directions.empty());

	// Turned, rises are roundings.
	const vec3 u = normalized(vec3(1, 0.3f, -0.7f)), v = normalized(vec3(0.2f, -0.9f, 0.4f)), n = normalized(glm::cross(u, v));
	Random random;
	for (int i = 0; i < 1000; ++i)
	{
		const DomainPoint p = random.domain();
		const vec3 weights = domainWeights(p), a(0.5f), b = a + 2.0f * u, c = a - v;
		const vec3 flat = weightedVec3(a, b, c, weights);
		ASSERT_LT(glm::length(pnPoint(flat, pnRises(a, b, c, n, n, n), n, n, n, weights) - flat), 1e-6f);
	}
}

TEST(pnTriangles, verticesWithoutADirectionLeaveTheirSideFlat)
{
	const vec3 a(0, 0, 0), b(1, 0, 0.5f), c(0, 1, -0.25f), none(0);
	Random random;
	for (int i = 0; i < 1000; ++i)
	{
		const vec3 weights = domainWeights(random.domain()), flat = weightedVec3(a, b, c, weights);
		ASSERT_TRUE(sameBits(pnPoint(flat, pnRises(a, b, c, none, none, none), none, none, none, weights), flat));
	}
}

TEST(pnTriangles, areOffUnlessAskedFor)
{
	const ReferenceScene scene(roundScene(2));
	EXPECT_FALSE(scene.built.traits.has_pn);
	EXPECT_TRUE(scene.built.directions.empty());
	EXPECT_EQ(scene.host.surface().pn_directions, 0u);
	for (const DisplacedBounds& bounds : scene.built.cluster_bounds)
		EXPECT_EQ(bounds.bulge, 0.0f);
}

// --- bounds ----------------------------------------------------------------------------------------------------------------------

TEST(pnTriangles, lieWithinTheHullOfTheirControlPointsAndThoseBoundTheClusters)
{
	Random random;
	for (const uint32_t cuts : { 1u, 3u })
	{
		const ReferenceScene scene(roundScene(cuts), defaultTable(), kPn);
		const Box mesh = displacedBox(scene.built.mesh_bounds[0], 1, 0);
		forEachTriangle(scene, [&](ClusterRef ref, uint32_t t) {
			const Box box = displacedBox(scene.built.cluster_bounds[ref.cluster], 1, 0);
			for (int i = 0; i < 200; ++i)
			{
				const vec3 p = sampleAtPoint(scene.host.surface(), scene.host.base(ref, t), random.domain()).base;
				for (const Box& bound : { box, mesh })
					ASSERT_TRUE(glm::all(glm::lessThanEqual(bound.low, p)) && glm::all(glm::lessThanEqual(p, bound.high)));
			}
		});
		// A sphere's hull is a little larger than it.
		EXPECT_LT(mesh.high.x, cuts == 1 ? 1.4f : 1.05f);
	}
}

TEST(pnTriangles, everyPieceLiesWithinTheBoxThatItsFlatCornersGive)
{
	Random random;
	for (const NamedScene& named : scenesWithAndWithoutDisplacement())
	{
		const ReferenceScene scene(named.scene, defaultTable(), kPn);
		const View view = viewOf(scene, framingCamera(scene.built), request(300, 5));
		forEachTriangle(scene, [&](ClusterRef ref, uint32_t t) {
			const BaseTriangle base = scene.host.base(ref, t);
			const TriangleCorners corners = triangleCorners(scene.host.surface(), base);
			const Placement placement = scene.host.placement(ref, view);
			const PlacedReach reach = placedReach(scene.built.cluster_bounds[ref.cluster], placement, view);
			// A piece around a point, of any size.
			const vec3 weights[3] = { domainWeights(random.domain()), domainWeights(random.domain()), domainWeights(random.domain()) };
			vec3 flat[3];
			for (int i = 0; i < 3; ++i)
				flat[i] = placed(placement, weightedVec3(corners.position0, corners.position1, corners.position2, weights[i]));
			const PieceBox box = pieceBox(flat[0], flat[1], flat[2], reach);
			for (int i = 0; i < 20; ++i)
			{
				const vec3 within = domainWeights(random.domain());
				const vec3 inside = weights[0] * within.x + weights[1] * within.y + weights[2] * within.z;
				const DomainPoint p = { uint32_t(inside.x * float(DOMAIN_SIZE)), uint32_t(inside.y * float(DOMAIN_SIZE)) };
				const vec3 at = placed(placement, surfacePoint(scene.host.surface(), base, p, placement, view).displaced);
				ASSERT_TRUE(glm::all(glm::lessThanEqual(glm::abs(at - box.centre), box.half_size))) << named.name;
			}
		});
	}
}

TEST(pnTriangles, curvedClustersAreNeverBackFacingAsAWhole)
{
	for (const DisplacedBounds& bounds : ReferenceScene(roundScene(6), defaultTable(), kPn).built.cluster_bounds)
		EXPECT_GT(bounds.cone_cutoff, 1.0f);
	EXPECT_LT(ReferenceScene(roundScene(6)).built.cluster_bounds[0].cone_cutoff, 1.0f);
}

// --- metrics ---------------------------------------------------------------------------------------------------------------------

TEST(pnTriangles, curvatureOfTheBaseCountsInTheMetrics)
{
	const Camera camera = cameraAt(dvec3(0, 0, 4), dvec3(0));
	const auto microTriangles = [&](Metric metric, bool pn, double rate) {
		const ReferenceScene scene(roundScene(2), defaultTable(), { .tables = MetricTables::of(metric), .pn = pn });
		return classifyAll(scene, viewOf(scene, camera, request(400, rate))).microTriangles();
	};
	// Flat triangles are one piece each; curved ones need more of them, and more at a finer rate, but fewer than by length.
	EXPECT_EQ(microTriangles(Metric::Detail, false, 2), 32u);
	const uint64_t coarse = microTriangles(Metric::Detail, true, 8), fine = microTriangles(Metric::Detail, true, 2);
	EXPECT_GT(coarse, 32u);
	EXPECT_GT(fine, coarse);
	EXPECT_LT(fine * 3, microTriangles(Metric::Edge, true, 2));
	// Curved edges are longer.
	EXPECT_GT(microTriangles(Metric::Displaced, true, 2), microTriangles(Metric::Displaced, false, 2));
}

TEST(pnTriangles, factorsOfTheMetricEdgeAreThoseOfTheFlatTriangles)
{
	for (const NamedScene& named : allScenes())
	{
		const ReferenceScene flat(named.scene), curved(named.scene, defaultTable(), kPn);
		const View view = viewOf(flat, framingCamera(flat.built), request(300, 4));
		EXPECT_EQ(reference::firstDifference(classifyAll(flat, view).parts, classifyAll(curved, view).parts), std::nullopt) << named.name;
	}
}

}  // namespace tessera::test
