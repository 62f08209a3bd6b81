// What is hidden falls off (--ray-hidden): how far it is taken to lie away follows what was measured, and factors follow that without a crack or an
// end to splitting.
#include "reference_test_scenes.h"

#include "reference/cover.h"
#include "reference/watertight.h"
#include "scene/builtin.h"
#include "scene/factor_rule.h"
#include "shared/edge_detail.h"

#include <gtest/gtest.h>

#include <random>

namespace tessera::test
{

namespace
{

using reference::Classified;

constexpr float kWhole = 50;
constexpr uint32_t kLongFrames = HIDDEN_WAIT_FRAMES + uint32_t(1 / HIDDEN_STEP) + 2;

HiddenInstance next(const HiddenInstance& last, float margin)
{
	return nextHidden(last, margin, kWhole);
}

HiddenInstance hiddenLong(float margin)
{
	HiddenInstance hidden = {};
	for (uint32_t i = 0; i < kLongFrames; ++i)
		hidden = next(hidden, margin);
	return hidden;
}

// Every instance at a distance of its own, some at none.
std::vector<HiddenInstance> randomlyHidden(const ReferenceScene& scene, uint32_t seed)
{
	std::mt19937 random(seed);
	std::uniform_real_distribution<float> share(-0.5f, 2);
	std::vector<HiddenInstance> hidden(scene.built.instances.size());
	for (HiddenInstance& instance : hidden)
		instance.distance_world = std::max(share(random), 0.0f) * static_cast<float>(boundingRadius(scene.built));
	return hidden;
}

View viewFallingOff(const ReferenceScene& scene, double rate_px, float falloff)
{
	ViewRequest asked = request(60, rate_px);
	asked.ray_falloff = falloff;
	return viewOf(scene, framingCamera(scene.built), asked);
}

}  // namespace

TEST(hiddenFalloff, waitsThenGrowsToWhatWasMeasuredAndStays)
{
	HiddenInstance hidden = {};
	for (uint32_t i = 1; i < HIDDEN_WAIT_FRAMES; ++i)
	{
		hidden = next(hidden, HIDDEN_FARTHEST);
		EXPECT_EQ(hidden.distance_world, 0) << i;
	}
	float before = 0;
	for (uint32_t i = 0; i < uint32_t(1 / HIDDEN_STEP); ++i)
	{
		hidden = next(hidden, HIDDEN_FARTHEST);
		EXPECT_NEAR(hidden.distance_world - before, kWhole * HIDDEN_STEP, kWhole * 1e-5) << i;
		before = hidden.distance_world;
	}
	for (uint32_t i = 0; i < 3; ++i)
	{
		hidden = next(hidden, HIDDEN_FARTHEST);
		EXPECT_EQ(hidden.distance_world, kWhole);
	}
}

TEST(hiddenFalloff, isNothingNearWhatMayBeSeenAndGrowsEvenlyFromThere)
{
	EXPECT_EQ(hiddenLong(0).distance_world, 0);
	EXPECT_EQ(hiddenLong(-0.02f).distance_world, 0);
	EXPECT_EQ(hiddenLong(HIDDEN_SAFE).distance_world, 0);
	float before = 0;
	for (float margin = HIDDEN_SAFE; margin <= HIDDEN_FARTHEST + 0.02f; margin += 0.001f)
	{
		const float distance = hiddenLong(margin).distance_world;
		EXPECT_GE(distance, before) << margin;
		EXPECT_LE(distance - before, 1.01f * kWhole * 0.001f / HIDDEN_RAMP) << margin;
		before = distance;
	}
	EXPECT_EQ(before, kWhole);
}

TEST(hiddenFalloff, fallsAtOnceAndWaitsAgainOnceItWasSeen)
{
	HiddenInstance hidden = next(hiddenLong(HIDDEN_FARTHEST), 0);
	EXPECT_EQ(hidden.distance_world, 0);
	for (uint32_t i = 1; i < HIDDEN_WAIT_FRAMES; ++i)
	{
		hidden = next(hidden, HIDDEN_FARTHEST);
		EXPECT_EQ(hidden.distance_world, 0) << i;
	}
	// Less than it was, but not seen.
	EXPECT_LT(next(hiddenLong(HIDDEN_FARTHEST), HIDDEN_FARTHEST - 0.01f).distance_world, kWhole);
	EXPECT_GT(next(hiddenLong(HIDDEN_FARTHEST), HIDDEN_FARTHEST - 0.01f).distance_world, 0);
}

// If not very fast, and evenly: it is as fine as in view in the last frame in which it is not seen.
TEST(hiddenFalloff, isNothingInTheFrameBeforeWhatComesNearerEvenlyIsSeen)
{
	for (const float speed : { 0.0005f, 0.003f, 0.02f, 0.06f, 0.1f })
		for (float start = 0; start < speed; start += speed / 7)
		{
			HiddenInstance hidden = hiddenLong(HIDDEN_FARTHEST);
			bool was_far = false;
			for (float margin = 2 * HIDDEN_FARTHEST + start; margin > 0; margin -= speed)
			{
				// No more than that is measured.
				hidden = next(hidden, std::min(margin, HIDDEN_FARTHEST));
				was_far |= hidden.distance_world == kWhole;
				EXPECT_TRUE(margin > speed || hidden.distance_world == 0) << speed << " at " << margin;
			}
			EXPECT_TRUE(was_far) << speed;
		}
}

TEST(hiddenFalloff, whatLiesFartherIsCoarserAndWhatLiesAtNothingIsAsItIs)
{
	const auto scene = builtinScene("instances:6");
	const View view = viewFallingOff(*scene, 2, 4), plain = viewFallingOff(*scene, 2, 0);
	uint64_t before = classifyAll(*scene, plain).microTriangles();
	std::vector<HiddenInstance> hidden(scene->built.instances.size());
	scene->host.setHidden(hidden);
	EXPECT_EQ(classifyAll(*scene, view).microTriangles(), before);
	for (const float share : { 0.1f, 0.5f, 2.0f })
	{
		for (HiddenInstance& instance : hidden)
			instance.distance_world = share * static_cast<float>(boundingRadius(scene->built));
		scene->host.setHidden(hidden);
		const uint64_t count = classifyAll(*scene, view).microTriangles();
		EXPECT_LT(count, before) << share;
		EXPECT_GE(count, scene->built.traits.instanced_triangles) << share;
		before = count;
		EXPECT_EQ(classifyAll(*scene, plain).microTriangles(), classifyAll(*scene, viewFallingOff(*scene, 2, 0)).microTriangles());
	}
}

TEST(hiddenFalloff, everySceneIsCoveredAndWatertight)
{
	std::vector<NamedScene> scenes = allScenes();
	for (const char* name : { "instances:4", "bricks" })
		scenes.push_back({ name, *makeBuiltinScene(name) });
	uint32_t number = 0;
	size_t fell_off = 0;
	for (const NamedScene& named : scenes)
	{
		const Metric metric = std::array{ Metric::Edge, Metric::Detail, Metric::Displaced }[number % 3];
		BuildOptions build;
		build.tables = MetricTables::of(metric);
		ReferenceScene scene(named.scene, defaultTable(), build);
		const reference::HostScene host(scene.built, defaultTable(), metric);
		const View view = viewFallingOff(scene, 3, 6);
		const uint64_t whole = reference::classify(host, view, factorRule(view, 11, 8), reference::allClusters(host)).microTriangles();
		reference::HostScene hidden(scene.built, defaultTable(), metric);
		hidden.setHidden(randomlyHidden(scene, ++number));
		const Classified result = reference::classify(hidden, view, factorRule(view, 11, 8), reference::allClusters(hidden));
		EXPECT_EQ(result.uncut_triangles, 0u) << named.name;
		const reference::CoverReport cover = checkCover(hidden, reference::allClusters(hidden), result.full_clusters, result.parts);
		EXPECT_TRUE(cover.holds()) << named.name << ": " << cover.first_problem;
		const reference::WatertightReport watertight = checkWatertight(hidden, view, result.full_clusters, result.parts);
		EXPECT_TRUE(watertight.holds()) << named.name << ": " << watertight.first_problem;
		fell_off += result.microTriangles() < whole;
	}
	EXPECT_GT(fell_off, scenes.size() / 3) << "nothing fell off: nothing is tested";
}

// Needles that pass close by the eye, at fine and at coarse rates.
TEST(hiddenFalloff, splittingEndsOnNeedles)
{
	size_t fell_off = 0;
	for (uint32_t i = 0; i < 60; ++i)
	{
		ReferenceScene scene(needleScene(i));
		const double height = std::pow(10, -0.5 - 2.0 * (i % 13) / 12.0);
		const dvec3 eye(i % 5 / 4.0, 0.1 * height, height);
		Camera camera = cameraAt(eye, eye + dvec3(i % 2 ? 1 : -1, 0.2, -0.4));
		camera.near_world = height / 2;
		for (const double rate : { 10.0, 60.0, 200.0 })
			for (const float distance : { 0.003f, 0.05f, 1.0f })
			{
				ViewRequest asked = request(1000, rate);
				asked.ray_falloff = 4;
				const View view = viewOf(scene, camera, asked);
				scene.host.setHidden({});
				const uint64_t whole = classifyAll(scene, view, i % 3 ? 8 : 2).microTriangles();
				scene.host.setHidden({ { distance, 0, 0 } });
				const Classified result = classifyAll(scene, view, i % 3 ? 8 : 2);
				ASSERT_EQ(result.uncut_triangles, 0u) << i << " at rate " << rate << ", " << distance;
				fell_off += result.microTriangles() < whole;
			}
	}
	EXPECT_GT(fell_off, 100u);
}

}  // namespace tessera::test
