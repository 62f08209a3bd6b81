// Segments that grow outside the view (--ray-falloff): nothing that can touch the picture changes, sides of an edge agree, counts follow the camera
// without a jump.
#include "reference_test_scenes.h"

#include "reference/cover.h"
#include "reference/evaluate.h"
#include "reference/watertight.h"
#include "scene/builtin.h"
#include "scene/factor_rule.h"
#include "shared/edge_detail.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

namespace tessera::test
{

namespace
{

using reference::Classified;
using reference::PieceKey;

constexpr Metric kMetrics[] = { Metric::Edge, Metric::Detail, Metric::Displaced };

std::unique_ptr<ReferenceScene> sceneFor(const ImportedScene& imported, Metric metric)
{
	BuildOptions options;
	options.tables = MetricTables::of(metric);
	return std::make_unique<ReferenceScene>(imported, defaultTable(), options);
}

ViewRequest fallingOff(double focal_px, double rate_px, float falloff)
{
	ViewRequest asked = request(focal_px, rate_px);
	asked.ray_falloff = falloff;
	return asked;
}

// Within the scene, where much of it lies beside and behind the eye.
std::vector<Camera> camerasWithin(const ReferenceScene& scene)
{
	const dvec3 low = scene.built.world_low, high = scene.built.world_high, size = high - low;
	std::vector<Camera> cameras = { framingCamera(scene.built) };
	for (const dvec3 at : { dvec3(0.5, 0.9, 0.5), dvec3(0.2, 1.1, 0.7), dvec3(-0.1, 0.6, 0.4) })
		cameras.push_back(cameraAt(low + size * at, low + size * dvec3(0.9, 0.3, 0.95 - at.x)));
	Camera parallel = cameras[1];
	parallel.orthographic = true;
	parallel.height_world = boundingRadius(scene.built) / 2;
	cameras.push_back(parallel);
	return cameras;
}

using BaseTriangleKey = std::tuple<uint32_t, uint32_t, uint32_t>;
struct Pieces
{
	std::vector<PieceKey> keys;
	bool is_one = false;  // all factors are 1
};
using PiecesByTriangle = std::map<BaseTriangleKey, Pieces>;

PiecesByTriangle piecesOf(const Classified& classified)
{
	PiecesByTriangle pieces;
	for (const reference::ReferencePiece& part : classified.parts)
	{
		Pieces& of_triangle = pieces[{ part.cluster.instance, part.cluster.cluster, part.piece.triangle }];
		of_triangle.is_one = of_triangle.keys.empty() && part.piece.a == 1;
		of_triangle.keys.push_back(keyOf(part));
	}
	return pieces;
}

// Some corner or middle of a micro-triangle lies in the picture.
bool touchesPicture(const reference::Evaluated& evaluated)
{
	const auto isInside = [](vec4 clip) {
		return clip.w > 0 && clip.z <= clip.w && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
	};
	for (const uvec3 triangle : evaluated.triangles)
	{
		const vec4 a = evaluated.vertices[triangle.x].clip, b = evaluated.vertices[triangle.y].clip, c = evaluated.vertices[triangle.z].clip;
		for (const vec4 clip : { a, b, c, (a + b) * 0.5f, (b + c) * 0.5f, (c + a) * 0.5f, (a + b + c) * (1 / 3.0f) })
			if (isInside(clip))
				return true;
	}
	return false;
}

struct Comparison
{
	size_t in_picture = 0, differing_in_picture = 0, differing = 0;
};

// Base triangles of which some micro-triangle touches the picture must be cut into the same pieces.
Comparison compare(const ReferenceScene& scene, const View& plain, const View& falling)
{
	const Classified with = classifyAll(scene, falling), without = classifyAll(scene, plain);
	const PiecesByTriangle cut_with = piecesOf(with), cut_without = piecesOf(without);
	std::map<BaseTriangleKey, bool> touches;
	for (const reference::ReferencePiece& part : without.parts)
	{
		bool& is_touching = touches[{ part.cluster.instance, part.cluster.cluster, part.piece.triangle }];
		is_touching = is_touching || touchesPicture(evaluatePart(scene.host, plain, part));
	}
	Comparison result;
	for (const auto& [triangle, pieces] : cut_without)
	{
		const auto found = cut_with.find(triangle);
		// Where no triangle of its cluster is cut any more it is in a full cluster.
		const bool is_same = found != cut_with.end() ? found->second.keys == pieces.keys : pieces.is_one;
		result.in_picture += touches[triangle];
		result.differing += !is_same;
		result.differing_in_picture += touches[triangle] && !is_same;
	}
	return result;
}

}  // namespace

// The bound that all rests on: in view, and for a whole base triangle's reach around it, nothing is added.
TEST(rayFalloff, nothingIsAddedToWhatCanTouchThePicture)
{
	std::mt19937 random(7);
	std::uniform_real_distribution<float> anywhere(-1, 1);
	const ReferenceScene scene(cubeScene(2));
	for (const Camera& camera : camerasWithin(scene))
	{
		const View view = viewOf(scene, camera, fallingOff(200, 4, 1000));
		const auto pointIn = [&] {
			return vec3(anywhere(random), anywhere(random), anywhere(random)) * 2.0f;
		};
		const auto isInside = [&](vec3 p) {
			const vec4 clip = clipPosition(p, view);
			return clip.w > 0 && viewDepth(p, view) >= 0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
		};
		size_t crossing = 0, beyond = 0;
		for (int i = 0; i < 200000; ++i)
		{
			const vec3 p = pointIn(), q = pointIn();
			const float reach = std::abs(anywhere(random)) * 0.2f;
			const float share = (anywhere(random) + 1) / 2;
			// A point of the edge, moved by less than the reach: in view, then the edge counts as seen.
			const vec3 moved = p * share + q * (1 - share) + glm::normalize(pointIn()) * (reach * 0.999f);
			const float added = unseenSquared(p, q, reach, view);
			ASSERT_EQ(floatBitsToUint(added), floatBitsToUint(unseenSquared(q, p, reach, view)));
			crossing += isInside(moved);
			beyond += added > 0;
			ASSERT_TRUE(added == 0 || !isInside(moved)) << i;
		}
		EXPECT_GT(crossing, 100u);
		EXPECT_GT(beyond, 1000u);
	}
}

// Splitting ends because a part of an edge never asks for more than the edge.
TEST(rayFalloff, aPartOfAnEdgeLiesAtLeastAsFarOutAsTheEdge)
{
	std::mt19937 random(8);
	std::uniform_real_distribution<float> anywhere(-1, 1);
	const ReferenceScene scene(cubeScene(2));
	for (const Camera& camera : camerasWithin(scene))
	{
		const View view = viewOf(scene, camera, fallingOff(200, 4, 4));
		for (int i = 0; i < 100000; ++i)
		{
			const vec3 p(anywhere(random), anywhere(random), anywhere(random)), q(anywhere(random), anywhere(random), anywhere(random));
			const float from = (anywhere(random) + 1) / 2, to = (anywhere(random) + 1) / 2;
			const float whole = unseenSquared(p, q, 0.01f, view);
			const float part = unseenSquared(p + (q - p) * from, p + (q - p) * to, 0.01f, view);
			ASSERT_GE(part, whole * 0.9999f - 1e-6f);
		}
	}
}

TEST(rayFalloff, leavesBaseTrianglesThatTouchThePictureAsTheyAre)
{
	size_t in_picture = 0, differing = 0;
	for (const char* name : { "terrain", "instances:2" })
		for (const Metric metric : kMetrics)
		{
			const auto scene = sceneFor(*makeBuiltinScene(name), metric);
			for (const Camera& camera : camerasWithin(*scene))
			{
				ViewRequest asked = request(40, 4);
				asked.displacement_scale = 1.5f;
				const View plain = viewOf(*scene, camera, asked);
				asked.ray_falloff = 20;
				const Comparison result = compare(*scene, plain, viewOf(*scene, camera, asked));
				EXPECT_EQ(result.differing_in_picture, 0u) << name << " " << metricName(metric);
				in_picture += result.in_picture;
				differing += result.differing;
			}
		}
	EXPECT_GT(in_picture, 1000u);
	EXPECT_GT(differing, 1000u) << "nothing fell off: nothing is tested";
}

TEST(rayFalloff, everySceneIsCoveredAndWatertightPartlyOutOfView)
{
	std::vector<NamedScene> scenes = allScenes();
	for (const char* name : { "terrain", "bricks", "quad", "materials", "instances:4" })
		scenes.push_back({ name, *makeBuiltinScene(name) });
	size_t number = 0;
	for (const NamedScene& named : scenes)
		for (const Metric metric : kMetrics)
		{
			const auto scene = sceneFor(named.scene, metric);
			const std::vector<Camera> cameras = camerasWithin(*scene);
			// In turn: not all of everything.
			const size_t camera = number++ % 2 ? 1 : 4;
			const View view = viewOf(*scene, cameras[camera], fallingOff(50, 5, 6));
			const Classified result = classifyAll(*scene, view);
			const std::string what = fmt::format("{} {} from {}", named.name, metricName(metric), camera);
			EXPECT_EQ(result.uncut_triangles, 0u) << what;
			const reference::CoverReport cover = checkCover(scene->host, reference::allClusters(scene->host), result.full_clusters, result.parts);
			EXPECT_TRUE(cover.holds()) << what << ": " << cover.first_problem;
			const reference::WatertightReport watertight = checkWatertight(scene->host, view, result.full_clusters, result.parts);
			EXPECT_TRUE(watertight.holds()) << what << ": " << watertight.first_problem;
		}
}

// Needles beside the eye, some of them out of view, at fine and at coarse rates.
TEST(rayFalloff, splittingEndsOnNeedlesOutOfView)
{
	size_t fell_off = 0;
	for (const Metric metric : kMetrics)
		for (uint32_t i = 0; i < 60; ++i)
		{
			const auto scene = sceneFor(needleScene(i), metric);
			// With a reach of nothing, edges fall off at once.
			BuiltScene near_view = scene->built;
			near_view.mesh_bounds[0].longest_edge = near_view.mesh_bounds[0].reach_low = near_view.mesh_bounds[0].reach_high = 0;
			const reference::HostScene host(near_view, defaultTable(), metric);
			const double height = std::pow(10, -0.5 - 2.0 * (i % 13) / 12.0);
			const dvec3 eye(i % 5 / 4.0, 0.1 * height, height);
			Camera camera = cameraAt(eye, eye + dvec3(i % 2 ? 1 : -1, 0.2, 0.4));
			camera.near_world = height / 2;
			for (const double rate : { 10.0, 60.0, 200.0 })
				for (const float falloff : { 1.0f, 40.0f, 1000.0f })
				{
					const View view = viewOf(*scene, camera, fallingOff(1000, rate, falloff));
					const Classified result = reference::classify(host, view, factorRule(view, 11, i % 3 ? 8 : 2), reference::allClusters(host));
					ASSERT_EQ(result.uncut_triangles, 0u) << metricName(metric) << " " << i << " at rate " << rate << ", falloff " << falloff;
					fell_off +=
						result.microTriangles() < classifyAll(*scene, viewOf(*scene, camera, request(1000, rate)), i % 3 ? 8 : 2).microTriangles();
				}
		}
	EXPECT_GT(fell_off, 100u);
}

// An object beside the eye, to which the camera turns a little at a time: once it comes into view it has been there at nearly that rate before.
TEST(rayFalloff, countsFollowTheCameraWithoutAJump)
{
	const auto scene = builtinScene("planet");
	const dvec3 middle = (scene->built.world_low + scene->built.world_high) / 2.0;
	const dvec3 eye = middle + dvec3(0, 0, 5 * boundingRadius(scene->built));
	const auto countAt = [&](double turn_deg, float falloff) {
		const double angle = turn_deg * 3.14159265358979 / 180;
		return double(
			classifyAll(*scene, viewOf(*scene, cameraAt(eye, eye + dvec3(std::sin(angle), 0, -std::cos(angle))), fallingOff(400, 2, falloff)))
				.microTriangles());
	};
	const double whole = countAt(0, 0), behind = countAt(180, 4);
	EXPECT_LT(behind, whole / 3) << "as coarse as the base mesh";
	EXPECT_EQ(countAt(0, 4), whole);
	EXPECT_EQ(countAt(180, 0), whole) << "without falloff a turn changes nothing";
	double before = behind, largest_step = 0;
	for (double turn_deg = 180; turn_deg >= 0; turn_deg -= 0.5)
	{
		const double count = countAt(turn_deg, 4);
		largest_step = std::max(largest_step, std::abs(count - before) / before);
		before = count;
	}
	EXPECT_EQ(before, whole);
	EXPECT_LT(largest_step, 0.05) << "half a degree";
}

TEST(rayFalloff, moreOfItLeavesFewerTriangles)
{
	for (const Metric metric : kMetrics)
	{
		const auto scene = sceneFor(*makeBuiltinScene("terrain"), metric);
		for (const Camera& camera : camerasWithin(*scene))
		{
			uint64_t before = classifyAll(*scene, viewOf(*scene, camera, fallingOff(50, 3, 0))).microTriangles();
			for (const float falloff : { 2.0f, 16.0f })
			{
				const uint64_t count = classifyAll(*scene, viewOf(*scene, camera, fallingOff(50, 3, falloff))).microTriangles();
				EXPECT_LE(count, before) << metricName(metric) << " at " << falloff;
				before = count;
			}
		}
	}
}

}  // namespace tessera::test
