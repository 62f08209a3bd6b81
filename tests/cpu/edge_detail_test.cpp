// The metrics `detail` and `displaced`: tables made at load and what edges make of them, against answers computed by hand and by other means.
#include "reference_test_scenes.h"

#include "reference/cover.h"
#include "reference/evaluate.h"
#include "reference/watertight.h"
#include "scene/builtin.h"
#include "shared/edge_detail.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>

namespace tessera::test
{

namespace
{

using reference::Classified;

struct Random
{
	explicit Random(uint32_t seed) : bits(seed) {}
	uint32_t below(uint32_t n) { return static_cast<uint32_t>(bits() % n); }

	std::mt19937 bits;
};

constexpr Metric kTableMetrics[] = { Metric::Detail, Metric::Displaced };

BuildOptions buildFor(Metric metric)
{
	BuildOptions options;
	options.tables = MetricTables::of(metric);
	return options;
}

std::unique_ptr<ReferenceScene> sceneFor(const ImportedScene& imported, Metric metric)
{
	return std::make_unique<ReferenceScene>(imported, defaultTable(), buildFor(metric));
}

template <typename Height>
Image heightImage(uint32_t size, const Height& heightAt)
{
	Image image = constantImage(size, size, TexelFormat::F32, 0);
	for (uint32_t y = 0; y < size; ++y)
		for (uint32_t x = 0; x < size; ++x)
		{
			const auto value = float(heightAt((x + 0.5) / size, (y + 0.5) / size));
			std::memcpy(image.texels.data() + (size_t(y) * size + x) * sizeof value, &value, sizeof value);
		}
	return image;
}

// A square of side 1 around the origin, facing +z, of two triangles; texture coordinates run from `low` to `high`.
ImportedScene squareOf(Image heights, float factor, float low, float high)
{
	ImportedScene scene;
	Primitive primitive;
	primitive.material = addDisplaced(scene, std::move(heights), factor, 0, Wrap::ClampToEdge);
	for (const vec2 corner : { vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1) })
		addVertex(primitive, vec3(corner - 0.5f, 0), vec3(0, 0, 1), low + corner * (high - low));
	addTriangle(primitive, 0, 1, 2);
	addTriangle(primitive, 0, 2, 3);
	addPlacedMesh(scene, { primitive });
	return scene;
}

// z = bend x^2, read between texel centres only.
constexpr float kBend = 0.125f;
ImportedScene parabola()
{
	return squareOf(heightImage(1024, [](double u, double) { return (u - 0.5) * (u - 0.5); }), 4 * kBend, 0.25f, 0.75f);
}

// `curve`: 0 to 2 of the base edges, 3 of the triangle.
int codeAt(const TriangleDetail& detail, uint32_t curve, uint32_t i)
{
	return int(detail.curves[2 * curve + i / 4] >> (8 * (i % 4)) & 0xffu) + detail.bias;
}

DomainPoint onEdge(uint32_t edge, uint32_t from_corner)
{
	const uint32_t rest = DOMAIN_SIZE - from_corner;
	return edge == 0 ? DomainPoint{ rest, from_corner } : edge == 1 ? DomainPoint{ 0, rest } : DomainPoint{ from_corner, 0 };
}

EdgeBase baseOf(uint32_t triangle)
{
	return { triangle, 1.0f, 0.0f, 0.0f };
}

uint64_t microTriangles(const ImportedScene& imported, Metric metric, const Camera& camera, const ViewRequest& asked)
{
	const auto scene = sceneFor(imported, metric);
	return classifyAll(*scene, viewOf(*scene, camera, asked)).microTriangles();
}

}  // namespace

// --- tables ----------------------------------------------------------------------------------------------------------------------

TEST(edgeDetail, curvesOfAParabolaAreItsChordsSagittas)
{
	const auto scene = sceneFor(parabola(), Metric::Detail);
	ASSERT_EQ(scene->built.triangle_details.size(), 2u);
	for (const TriangleDetail& detail : scene->built.triangle_details)
		for (uint32_t i = 0; i < 8; ++i)
		{
			// A chord of length h lies bend h^2 / 4 above the middle; the slope (at most 2 bend x) tilts it by at most 3 in 1000.
			const double length = std::exp2(-double(i)), deviation = kBend * length * length / 4;
			const double code = 8 * std::log2(deviation);
			for (uint32_t curve = 0; curve < 4; ++curve)
				EXPECT_NEAR(codeAt(detail, curve, i), code, 1.2) << curve << " " << i;
		}
}

TEST(edgeDetail, aParabolaGetsHandComputedFactors)
{
	// Side 1, 2 away, focal length 500 px. Tolerance: half of the rate. Rate 8: 8 / 500 * 2 = 0.032 units a segment by length, so 31; 0.016 units
	// off are allowed: a chord of 2 sqrt(0.016 / bend) = 0.716, so 1.4 segments, 1. Rate 1: 0.002 units: 0.253, so 3.95 segments, 4.
	const auto scene = sceneFor(parabola(), Metric::Detail);
	Camera camera = cameraAt(dvec3(0, 0, 2), dvec3(0));
	camera.orthographic = true;
	camera.height_world = 1;  // one distance for all: 1 / rate px
	for (const auto& [pixels, factor] : { std::pair{ 0.032, 1u }, std::pair{ 0.004, 4u }, std::pair{ 0.001, 8u } })
	{
		const View view = viewOf(*scene, camera, request(500, pixels * 1000));
		const vec3 p = vec3(-0.5f, -0.5f, -2) * view.unit, q = vec3(0.5f, -0.5f, -2) * view.unit;
		EdgeBase base = baseOf(0);
		base.inverse_scale_squared = view.inverse_unit_squared;
		const EdgeView edge = edgeByMetric(scene->host.surface(), base, domainCorner(0), domainCorner(1), p, q, view);
		EXPECT_EQ(edgeFactor(edge, { 11, 8 }), factor) << pixels;
	}
}

TEST(edgeDetail, whatIsFlatIsNotCut)
{
	const ImportedScene flat = squareOf(constantImage(16, 16, TexelFormat::U8, 200), 0.3f, 0, 1);
	const Camera camera = cameraAt(dvec3(0, 0, 2), dvec3(0));
	EXPECT_EQ(microTriangles(flat, Metric::Detail, camera, request(500, 2)), 2u);
	EXPECT_GT(microTriangles(flat, Metric::Edge, camera, request(500, 2)), 1000u);
	const ImportedScene plain = triangleScene({ vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0) });
	EXPECT_EQ(microTriangles(plain, Metric::Detail, camera, request(500, 2)), 1u);
}

// One texel of a large map stands out; wherever it is, it is found from near and far.
TEST(edgeDetail, aSingleTexelIsNotMissed)
{
	constexpr uint32_t kSize = 256;
	Random random(7);
	for (int i = 0; i < 12; ++i)
	{
		const uint32_t x = random.below(kSize - 16) + 8, y = random.below(kSize - 16) + 8;
		Image image = constantImage(kSize, kSize, TexelFormat::U8, 10);
		image.texels[size_t(y) * kSize + x] = std::byte(250);
		const ImportedScene imported = squareOf(image, 0.1f, 0, 1);
		const dvec3 there((x + 0.5) / kSize - 0.5, (y + 0.5) / kSize - 0.5, 0);
		for (const double height : { 0.2, 0.8 })
		{
			double highest[2] = {};
			for (const Metric metric : { Metric::Edge, Metric::Detail })
			{
				const auto scene = sceneFor(imported, metric);
				const View view = viewOf(*scene, cameraAt(there + dvec3(0, 0, height), there), request(400, 2));
				for (const reference::ReferencePiece& part : classifyAll(*scene, view).parts)
					for (const reference::MicroVertex& vertex : reference::evaluatePart(scene->host, view, part).vertices)
						highest[metric == Metric::Detail] = std::max(highest[metric == Metric::Detail], double(vertex.displaced.z));
			}
			EXPECT_GE(highest[1], 0.9 * highest[0]) << x << " " << y << " from " << height;
		}
	}
}

// --- what both sides share -------------------------------------------------------------------------------------------------------

TEST(edgeDetail, isTheSameFromBothEndsAndFromEverySideOfABaseEdge)
{
	Random random(3);
	for (const NamedScene& named : allScenes())
		for (const Metric metric : kTableMetrics)
		{
			const auto scene = sceneFor(named.scene, metric);
			const View view = viewOf(*scene, framingCamera(scene->built), request(400, 0.3));
			// The sides of an edge, by the welded vertices that it starts and ends at.
			struct Side
			{
				uint32_t triangle, edge;
				bool from_first;
				vec3 start, end;
			};
			std::map<std::pair<uint32_t, uint32_t>, std::vector<Side>> edges;
			for (const ClusterRecord& cluster : scene->built.clusters)
				for (uint32_t t = cluster.first_triangle; t < cluster.first_triangle + clusterTriangles(cluster); ++t)
					for (uint32_t e = 0; e < 3; ++e)
					{
						const uint32_t a = cluster.first_vertex + triangleVertex(scene->built.triangles[t], e);
						const uint32_t b = cluster.first_vertex + triangleVertex(scene->built.triangles[t], (e + 1) % 3);
						const uint32_t wa = scene->built.weld_ids[a], wb = scene->built.weld_ids[b];
						const bool first = wa < wb;
						edges[std::minmax(wa, wb)].push_back(
							{ t, e, first, scene->built.positions[first ? a : b], scene->built.positions[first ? b : a] });
					}
			for (const auto& [welds, sides] : edges)
				for (int i = 0; i < 6; ++i)
				{
					// A piece, from the start: all of it, or down to a thousandth.
					const uint32_t length = i == 0 ? DOMAIN_SIZE : std::max(16u, uint32_t(DOMAIN_SIZE * std::exp2(-0.01 * random.below(1000))));
					const uint32_t begin = random.below(DOMAIN_SIZE - length + 1);
					std::vector<EdgeView> views;
					for (const Side& side : sides)
					{
						const auto at = [&](uint32_t from_start) {
							return onEdge(side.edge, side.from_first ? from_start : DOMAIN_SIZE - from_start);
						};
						const DomainPoint p = at(begin), q = at(begin + length);
						const EdgeBase base = baseOf(side.triangle);
						views.push_back(edgeByMetric(scene->host.surface(), base, p, q, side.start, side.end, view));
						views.push_back(edgeByMetric(scene->host.surface(), base, q, p, side.end, side.start, view));
					}
					for (const EdgeView& other : views)
					{
						ASSERT_EQ(other.unit_squared, views[0].unit_squared) << named.name << " " << welds.first << "-" << welds.second;
						ASSERT_EQ(other.length_squared, views[0].length_squared) << named.name;
						ASSERT_EQ(other.limit, views[0].limit) << named.name;
					}
				}
		}
}

TEST(edgeDetail, innerEdgesAreTheSameFromBothEnds)
{
	const auto scene = builtinScene("planet", buildFor(Metric::Detail));
	const View view = viewOf(*scene, framingCamera(scene->built), request(400, 0.2));
	Random random(5);
	const auto inside = [&] {
		const uint32_t u = random.below(DOMAIN_SIZE + 1);
		return DomainPoint{ u, random.below(DOMAIN_SIZE - u + 1) };
	};
	for (int i = 0; i < 20000; ++i)
	{
		const EdgeBase base = baseOf(random.below(uint32_t(scene->built.triangles.size())));
		const DomainPoint p = inside(), q = inside();
		const EdgeView forth = edgeByMetric(scene->host.surface(), base, p, q, vec3(0, 0, 1), vec3(0.5f, 0, 1), view);
		const EdgeView back = edgeByMetric(scene->host.surface(), base, q, p, vec3(0.5f, 0, 1), vec3(0, 0, 1), view);
		ASSERT_EQ(forth.unit_squared, back.unit_squared);
	}
}

TEST(edgeDetail, neverAsksForMoreThanEdgeAndForMoreTheFinerTheRate)
{
	for (const char* name : { "planet", "terrain", "cube", "materials", "quad", "instances:2" })
	{
		const auto detail = builtinScene(name, buildFor(Metric::Detail)), edge = builtinScene(name);
		uint64_t finer = 0;
		for (const double rate : { 4.0, 8.0, 16.0 })
		{
			const Camera camera = framingCamera(edge->built);
			const uint64_t by_detail = classifyAll(*detail, viewOf(*detail, camera, request(300, rate))).microTriangles();
			EXPECT_LE(by_detail, classifyAll(*edge, viewOf(*edge, camera, request(300, rate))).microTriangles()) << name << " " << rate;
			EXPECT_TRUE(finer == 0 || by_detail <= finer) << name << " " << rate;
			finer = by_detail;
		}
	}
}

TEST(edgeDetail, tablesAreMadeOnlyWhenAskedForAndTheSameEveryTime)
{
	const auto plain = builtinScene("cube"), once = builtinScene("cube", buildFor(Metric::Detail)),
			   again = builtinScene("cube", buildFor(Metric::Detail));
	EXPECT_TRUE(plain->built.triangle_details.empty() && plain->built.edge_roughness.empty());
	EXPECT_TRUE(once->built.edge_roughness.empty());
	ASSERT_EQ(once->built.triangle_details.size(), again->built.triangle_details.size());
	EXPECT_EQ(std::memcmp(once->built.triangle_details.data(), again->built.triangle_details.data(),
						  once->built.triangle_details.size() * sizeof(TriangleDetail)),
			  0);
}

// --- contracts -------------------------------------------------------------------------------------------------------------------

TEST(edgeDetail, everySceneIsCoveredAndWatertightNearAndFar)
{
	std::vector<NamedScene> scenes = allScenes();
	for (const char* name : { "planet", "terrain", "bricks", "cube", "quad", "materials", "instances:2", "showcase:2" })
		scenes.push_back({ name, *makeBuiltinScene(name) });
	for (const NamedScene& named : scenes)
		for (const Metric metric : kTableMetrics)
		{
			const auto scene = sceneFor(named.scene, metric);
			const Camera far = framingCamera(scene->built);
			Camera near = far;
			near.eye = far.target + (far.eye - far.target) * 0.4;
			for (const Camera& camera : { far, near })
			{
				const View view = viewOf(*scene, camera, request(250, 4));
				const Classified result = classifyAll(*scene, view);
				EXPECT_EQ(result.uncut_triangles, 0u) << named.name << " " << metricName(metric);
				const reference::CoverReport cover = checkCover(scene->host, reference::allClusters(scene->host), result.full_clusters, result.parts);
				EXPECT_TRUE(cover.holds()) << named.name << ": " << cover.first_problem;
				const reference::WatertightReport watertight = checkWatertight(scene->host, view, result.full_clusters, result.parts);
				EXPECT_TRUE(watertight.holds()) << named.name << " " << metricName(metric) << ": " << watertight.first_problem;
			}
		}
}

// Needles close by the eye, rough enough for every piece to matter: factors of parts of an edge may exceed those of the whole, so that nothing proves
// an end.
TEST(edgeDetail, splittingEndsOnDisplacedNeedles)
{
	for (const Metric metric : kTableMetrics)
		for (uint32_t i = 0; i < 60; ++i)
		{
			const auto scene = sceneFor(needleScene(i), metric);
			const double height = std::pow(10, -0.5 - 2.0 * (i % 13) / 12.0);
			const dvec3 near_point(i % 5 / 4.0, 0, 0);
			Camera camera = cameraAt(near_point + dvec3(0, 0.1 * height, height), near_point + dvec3(0.1, 0.3, -0.1));
			camera.near_world = height / 2;
			for (const double rate : { 10.0, 60.0, 200.0 })
				for (const uint32_t max_split : { 2u, 8u })
				{
					const Classified result = classifyAll(*scene, viewOf(*scene, camera, request(1000, rate)), max_split);
					ASSERT_EQ(result.uncut_triangles, 0u) << metricName(metric) << " " << i << " at rate " << rate;
				}
		}
}

// --- displaced -------------------------------------------------------------------------------------------------------------------

TEST(edgeDisplaced, aRampIsAsLongAsItsSlopeSays)
{
	// Heights rise by 1 over the side: displaced, an edge along it is sqrt(2) as long, (sqrt 2)^2 - 1 = 1; across it stays.
	const auto scene = sceneFor(squareOf(heightImage(256, [](double u, double) { return u; }), 2, 0.25f, 0.75f), Metric::Displaced);
	for (uint32_t t = 0; t < 2; ++t)
		for (uint32_t e = 0; e < 3; ++e)
		{
			const BaseTriangle base = scene->host.base({ 0, 0 }, t);
			const uint32_t corners[] = { base.v0, base.v1, base.v2 };
			const vec3 along = scene->built.positions[corners[(e + 1) % 3]] - scene->built.positions[corners[e]];
			const double length_squared = double(glm::dot(along, along));
			EXPECT_NEAR(scene->built.edge_roughness[t][int(e)], double(along.x * along.x) / length_squared, 0.02);
		}
}

TEST(edgeDisplaced, edgesSeenFromTheirEndsGetFewer)
{
	const auto scene = sceneFor(squareOf(constantImage(4, 4, TexelFormat::U8, 0), 1, 0, 1), Metric::Displaced);
	const View view = viewOf(*scene, cameraAt(dvec3(0, 0, 3), dvec3(0)), request(500, 4));
	const EdgeBase base = baseOf(0);
	const auto factor = [&](vec3 p, vec3 q) {
		return edgeFactor(edgeByMetric(scene->host.surface(), base, domainCorner(0), domainCorner(1), p * view.unit, q * view.unit, view),
						  { 100, 8 });
	};
	// Both 0.1 long; the nearer end 2 away: 0.1 / 2 * 500 / 4 = 6.25. From its end: at least a quarter, 1.56.
	EXPECT_EQ(factor(vec3(0, 0, -2), vec3(0.1f, 0, -2)), 6u);
	EXPECT_EQ(factor(vec3(0, 0, -2), vec3(0, 0, -2.1f)), 2u);
}

}  // namespace tessera::test
