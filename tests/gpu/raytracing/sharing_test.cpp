// Structures that instances share: the same picture as without, counts that say what was shared, made once and again when what they are made of
// changes.
#include "ray_frames.h"
#include "ray_test.h"

#include "verify/frame_source.h"

#include "pipeline/passes.h"
#include "raytracing/place_instances.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tessera::test
{

namespace
{

using sharing = RayTest;

// Balls of 72 triangles: a row of `count` that are turned, scaled and partly mirrored, and a large one below them. Not displaced.
ImportedScene ballsScene(uint32_t count)
{
	ImportedScene scene = roundScene(3);
	for (uint32_t i = 1; i < count; ++i)
	{
		dmat4 world = glm::translate(dmat4(1), dvec3(2.5 * i, 0.3 * (i % 3), -0.8 * (i % 4)));
		world = glm::rotate(world, 0.7 * i, glm::normalize(dvec3(1, 0.4 * i, 2)));
		scene.instances.push_back({ 0, glm::scale(world, dvec3(i % 2 ? -1 : 1, 0.6 + 0.2 * (i % 3), 1)) });
	}
	return scene;
}

// A plain mesh and a displaced one, side by side.
ImportedScene mixedScene()
{
	ImportedScene scene = cubeScene(2);
	const ImportedScene ball = roundScene(2);
	Mesh mesh = ball.meshes[0];
	for (Primitive& primitive : mesh.primitives)
		primitive.material = addPlain(scene, "plain");
	scene.meshes.push_back(mesh);
	for (int i = 0; i < 4; ++i)
		scene.instances.push_back({ 1, glm::translate(dmat4(1), dvec3(3.0 * i - 3, 2.5, i)) });
	scene.instances.push_back({ 0, glm::translate(dmat4(1), dvec3(3, 0, 0)) });
	return scene;
}

RenderOptions withSharing(RenderOptions options, bool shares)
{
	options.ray_sharing = shares;
	return options;
}

struct Difference
{
	size_t pixels = 0;  // that differ by more than what moves light's rays off the surface can change
	size_t covered = 0;
};

// Pictures with and without sharing, from renderers of their own.
Difference comparePictures(const GpuScene& scene, const RenderOptions& options, const Camera& camera, uint64_t least_shared)
{
	const Drawn with = drawnBy(*rendererOf(scene, options), camera), without = drawnBy(*rendererOf(scene, withSharing(options, false)), camera);
	EXPECT_GE(with.result.rays.shared_instances, least_shared);
	EXPECT_EQ(without.result.rays.shared_instances, 0u);
	EXPECT_EQ(without.result.rays.shared_bytes, 0u);
	EXPECT_EQ(with.result.counts.micro_triangles, without.result.counts.micro_triangles);
	EXPECT_EQ(with.result.counts.visible_clusters, without.result.counts.visible_clusters);
	return { differingPixels(with.picture, without.picture, 8), size_t(without.result.counts.covered_pixels) };
}

}  // namespace

TEST_F(sharing, raysSeeWhatTheComputeRasteriserSees)
{
	const GpuScene balls(ballsScene(9));
	EXPECT_GT(expectSameVisibility(balls, "balls", 0, camerasOf(balls, 21, 5)), 9u);
	EXPECT_GT(expectSameVisibility(balls, "balls", 5, camerasOf(balls, 22, 5)), 5u);
	RenderOptions culled = rayOptions(5, Raster::Rt);
	culled.cull = { true, true, false };
	EXPECT_GT(expectSameVisibility(balls, "balls, culled", culled, camerasOf(balls, 23, 5)), 5u);
}

// Displaced meshes share where nothing is tessellated.
TEST_F(sharing, displacedInstancesShareAtRate0Alone)
{
	const auto scene = gpuScene("instances:20");
	EXPECT_GT(expectSameVisibility(*scene, "instances", 0, camerasOf(*scene, 31, 3)), 10u);
	const Drawn coarse = drawnBy(*rendererOf(*scene, rayOptions(40, Raster::Rt)), scene->camera);
	EXPECT_EQ(coarse.result.rays.shared_instances, 0u) << "heights are of a mip by distance";
	RenderOptions flat = rayOptions(40, Raster::Rt);
	flat.displacement_scale = 0;
	EXPECT_GT(drawnBy(*rendererOf(*scene, flat), scene->camera).result.rays.shared_instances, 5u);
}

TEST_F(sharing, mirroredShearedAndNearInstancesAreSeenAsTheyAre)
{
	const GpuScene uneven(unevenScene());
	EXPECT_GT(expectSameVisibility(uneven, "uneven", 0, camerasOf(uneven, 41, 4)), 3u);
	// From within the row: some share, some are too near.
	const GpuScene balls(ballsScene(9));
	Camera within = squareCamera(dvec3(-1.15, 0.1, 0.05), dvec3(12, 0.5, -1));
	const uint64_t shared = expectSameVisibility(balls, "balls from near", 0, { { "near", within } });
	EXPECT_GT(shared, 0u);
	EXPECT_LT(shared, 9u);
}

TEST_F(sharing, sidesOfMaterialsAreKnown)
{
	ImportedScene imported = soupScene(3, 60);
	imported.materials[0].double_sided = true;
	for (const double x : { 6.0, 12.0 })
		imported.instances.push_back({ 0, glm::scale(glm::translate(dmat4(1), dvec3(x, 0, -2)), dvec3(-1, 1, 1)) });
	const GpuScene soup(imported);
	ASSERT_TRUE(soup.built.traits.has_single_sided && soup.built.traits.has_double_sided && soup.built.traits.has_mirrored_instances);
	EXPECT_GT(expectSameVisibility(soup, "soup", 0, camerasOf(soup, 51, 4)), 2u);
	ImportedScene single = ballsScene(4);
	const GpuScene balls(single);
	EXPECT_GT(expectSameVisibility(balls, "single-sided, from within too", 0, camerasOf(balls, 52, 4)), 2u);
}

TEST_F(sharing, tessellatedInstancesStayInTheFramesStructure)
{
	const GpuScene balls(ballsScene(9));
	const Camera camera = squareCamera(dvec3(-4, 1, 1.5), dvec3(20, 0, -2));
	const RenderOptions options = rayOptions(2, Raster::Rt);
	const Drawn with = drawnBy(*rendererOf(balls, options), camera);
	const uint64_t shared = with.result.rays.shared_instances;
	EXPECT_GT(shared, 0u);
	EXPECT_LT(shared, 9u);
	EXPECT_GT(with.result.counts.part_triangles, 0u);
	EXPECT_EQ(listOf(with.result, "ray_geometry").wanted, with.result.counts.micro_triangles - shared * 72);
	EXPECT_EQ(listOf(with.result, "expanded_triangles").wanted, with.result.counts.micro_triangles - shared * 72);
	EXPECT_EQ(with.result.rays.shared_structures, 1u);
	const Difference difference = comparePictures(balls, options, camera, 1);
	EXPECT_LE(difference.pixels * 100, difference.covered);
}

// Too few entries for the rate: everything is listed again, and what shares still is.
TEST_F(sharing, aCoarsenedFrameStillShares)
{
	const GpuScene balls(ballsScene(9));
	const Camera camera = squareCamera(dvec3(-3, 1, 1), dvec3(20, 0, -2));
	RenderOptions options = rayOptions(4, Raster::Rt);
	options.capacities = { { "part_triangles", 60 } };
	const Drawn with = drawnBy(*rendererOf(balls, options), camera), without = drawnBy(*rendererOf(balls, withSharing(options, false)), camera);
	EXPECT_GT(with.result.coarsening, 0u);
	EXPECT_EQ(with.result.coarsening, without.result.coarsening);
	EXPECT_GT(with.result.rays.shared_instances, 0u);
	EXPECT_EQ(with.result.counts.micro_triangles, without.result.counts.micro_triangles);
	EXPECT_EQ(listOf(with.result, "ray_geometry").wanted, with.result.counts.micro_triangles - with.result.rays.shared_instances * 72);
	EXPECT_LE(differingPixels(with.picture, without.picture, 8) * 100, without.result.counts.covered_pixels);
}

TEST_F(sharing, lightIsTheSameWithEveryRasteriser)
{
	const GpuScene balls(ballsScene(6));
	const Camera camera = squareCamera(dvec3(4, 3, 7), dvec3(6, 0, -1));
	for (const auto& [raster, rate] : { std::pair(Raster::Soft, 14.0f), std::pair(Raster::Rt, 14.0f), std::pair(Raster::Mesh, 0.0f) })
	{
		if (raster == Raster::Mesh && !gpu().gates.mesh_shader)
			continue;
		RenderOptions options = rayOptions(rate, raster);
		options.shadows = true;
		options.ao_samples = 2;
		const Difference difference = comparePictures(balls, options, camera, 1);
		EXPECT_LE(difference.pixels * 50, difference.covered) << "--raster " << rasterName(raster) << " at rate " << rate;
	}
	RenderOptions indexed = rayOptions(0, Raster::Indexed);
	indexed.shadows = true;
	EXPECT_EQ(drawnBy(*rendererOf(balls, indexed), camera).result.rays.shared_instances, 0u);
}

// No speckles from near or far: what is lit without sharing is lit with it.
TEST_F(sharing, aConvexBodyDoesNotShadowItself)
{
	ImportedScene imported = roundScene(8);
	imported.instances[0].world = glm::rotate(dmat4(1), 0.5, glm::normalize(dvec3(1, 2, 3)));
	const GpuScene ball(imported);
	RenderOptions options = rayOptions(0, Raster::Soft);
	options.shadows = true;
	const auto make = [&](bool shares) {
		auto renderer = Renderer::create(gpu(), ball.built, ball.table, framePasses(), withSharing(options, shares), { { "kept_visibility" } });
		EXPECT_TRUE(renderer);
		return std::move(*renderer);
	};
	const auto shared = make(true), own = make(false);
	for (const double distance : { 4.0, 40.0 })
	{
		Camera camera = squareCamera(dvec3(0.48, 0.65, 0.58) * distance, dvec3(0));
		camera.fov_y_rad = 2 / distance;
		EXPECT_EQ(drawnBy(*shared, camera).result.rays.shared_instances, 1u) << distance;
		drawnBy(*own, camera);
		const auto floats = [](Renderer& renderer) {
			const auto bytes = renderer.readResource("sun_visibility");
			EXPECT_TRUE(bytes);
			std::vector<float> values(bytes->size() / sizeof(float));
			std::memcpy(values.data(), bytes->data(), values.size() * sizeof(float));
			return values;
		};
		const std::vector<float> with = floats(*shared), without = floats(*own);
		const auto words = own->readResource("kept_visibility");
		ASSERT_TRUE(words);
		size_t lit = 0, differ = 0;
		for (size_t i = 0; i < with.size(); ++i)
		{
			uint64_t word = 0;
			std::memcpy(&word, words->data() + i * sizeof(word), sizeof(word));
			lit += word != 0 && without[i] == 1;
			differ += word != 0 && with[i] != without[i];
		}
		EXPECT_GT(lit, 500u) << distance;
		EXPECT_EQ(differ, 0u) << distance;
	}
}

// Every visible triangle of a shared instance is named as it is without: instance, cluster, triangle.
TEST_F(sharing, hitsNameTheSameTriangles)
{
	const GpuScene balls(ballsScene(9));
	const Camera camera = squareCamera(dvec3(-2, 2, 6), dvec3(8, 0, -1));
	const auto captureOf = [&](bool shares) {
		auto source =
			verify::FrameSource::create(gpu(), balls.host, balls.built, balls.table, withSharing(rayOptions(0, Raster::Rt), shares), false, {}, 1);
		EXPECT_TRUE(source);
		auto capture = (*source)->capture(camera, 0);
		EXPECT_TRUE(capture);
		return std::move(*capture);
	};
	const verify::Capture with = captureOf(true), without = captureOf(false);
	EXPECT_GT(with.result.rays.shared_instances, 5u);
	size_t differ = 0, covered = 0;
	for (size_t i = 0; i < with.visible.pixels.size(); ++i)
	{
		const verify::VisiblePixel &a = with.visible.pixels[i], &b = without.visible.pixels[i];
		covered += b.covered();
		differ += a.covered() != b.covered() || (a.covered() && a.identity != b.identity);
	}
	EXPECT_GT(covered, 150u);
	EXPECT_LE(differ, 1u) << "more than a pixel whose centre lies on an edge";
}

TEST_F(sharing, structuresAreMadeOnceAndAgainWhenDisplacementChanges)
{
	const auto scene = gpuScene("instances:12");
	RenderOptions options = rayOptions(0, Raster::Rt);
	const auto renderer = rendererOf(*scene, options);
	ASSERT_TRUE(renderer);
	const auto builds = [](const Drawn& drawn) {
		return std::ranges::any_of(drawn.result.passes, [](const PassTime& pass) { return pass.name == "build_meshes"; });
	};
	const Drawn first = drawnBy(*renderer, scene->camera), second = drawnBy(*renderer, scene->camera), third = drawnBy(*renderer, scene->camera);
	EXPECT_TRUE(builds(first));
	EXPECT_FALSE(builds(second));
	EXPECT_GT(first.result.rays.shared_instances, 5u);
	EXPECT_LE(second.result.rays.shared_bytes, first.result.rays.shared_bytes) << "compacted";
	EXPECT_EQ(differingPixels(first.picture, second.picture), 0u);
	EXPECT_EQ(differingPixels(first.picture, third.picture), 0u);
	EXPECT_EQ(third.result.attempts, 1u);
	for (const float offset : { 0.05f, 0.1f })
	{
		options.displacement_offset = offset;
		ASSERT_TRUE(renderer->setOptions(options));
		const Drawn moved = drawnBy(*renderer, scene->camera), fresh = drawnBy(*rendererOf(*scene, options), scene->camera);
		EXPECT_TRUE(builds(moved)) << offset;
		EXPECT_EQ(differingPixels(moved.picture, fresh.picture), 0u) << offset;
		EXPECT_GT(differingPixels(moved.picture, first.picture), 20u) << offset;
	}
	options.ray_sharing = false;
	ASSERT_TRUE(renderer->setOptions(options));
	EXPECT_EQ(drawnBy(*renderer, scene->camera).result.rays.shared_bytes, 0u);
}

// Where nothing is shared from here, nothing of it is planned, and structures of rate 0 are still refitted.
TEST_F(sharing, whatSharesNothingPaysNothing)
{
	const GpuScene ball(roundScene(3));
	const auto renderer = rendererOf(ball, rayOptions(0, Raster::Rt));
	const Camera within = squareCamera(dvec3(0, 0, 0.3), dvec3(0, 0, -1)), outside = squareCamera(dvec3(0, 0, 4), dvec3(0));
	const Drawn near = drawnBy(*renderer, within);
	EXPECT_EQ(near.result.rays.shared_bytes, 0u);
	for (const char* name : { "shared_instances", "shared_clusters", "mesh_addresses", "mesh_structures", "mesh_inputs" })
		EXPECT_FALSE(renderer->plan().keeps(name)) << name;
	EXPECT_TRUE(drawnBy(*renderer, within).result.rays.refitted);
	const Drawn far = drawnBy(*renderer, outside);
	EXPECT_EQ(far.result.rays.shared_instances, 1u);
	EXPECT_EQ(listOf(far.result, "ray_geometry").wanted, 0u);
	EXPECT_EQ(differingPixels(drawnBy(*renderer, within).picture, near.picture), 0u);
}

TEST_F(sharing, plainMeshesShareBesideDisplacedOnes)
{
	const GpuScene mixed(mixedScene());
	EXPECT_GT(expectSameVisibility(mixed, "mixed", 10, camerasOf(mixed, 61, 4)), 2u);
	EXPECT_GT(expectSameVisibility(mixed, "mixed", 0, camerasOf(mixed, 62, 3)), 4u);
	RenderOptions light = rayOptions(10, Raster::Soft);
	light.shadows = true;
	const Difference difference = comparePictures(mixed, light, mixed.camera, 1);
	EXPECT_LE(difference.pixels * 50, difference.covered);
}

TEST_F(sharing, aSceneInRoundsIsDrawnWithoutAndTheSame)
{
	const GpuScene balls(ballsScene(40));
	RenderOptions options = rayOptions(0, Raster::Rt);
	const Drawn whole = drawnBy(*rendererOf(balls, options), balls.camera);
	options.capacities = { { "visible_clusters", 64 } };
	const Drawn parts = drawnBy(*rendererOf(balls, options), balls.camera);
	EXPECT_GT(whole.result.rays.shared_instances, 30u);
	EXPECT_GT(parts.result.rounds, 1u);
	EXPECT_EQ(parts.result.rays.shared_instances, 0u);
	EXPECT_LE(differingPixels(whole.picture, parts.picture, 8) * 100, whole.result.counts.covered_pixels);
}

// Clusters of an attempt that does not fit may be listed nowhere, so rays must not meet them: nothing is placed.
TEST_F(sharing, whatDoesNotFitIsNotPlaced)
{
	const GpuScene balls(ballsScene(40));
	const auto placed = [&](std::map<std::string, uint32_t> capacities, bool fits) {
		RenderOptions options = rayOptions(0, Raster::Soft);
		options.shadows = true;
		options.capacities = std::move(capacities);
		const auto renderer = rendererOf(balls, options);
		EXPECT_EQ(bool(renderer->renderFrame(balls.camera)), fits) << "light's rays need whole frames";
		const auto bytes = renderer->readResource("ray_instances");
		EXPECT_TRUE(bytes);
		std::vector<RayInstance> instances(bytes->size() / sizeof(RayInstance));
		std::memcpy(instances.data(), bytes->data(), instances.size() * sizeof(RayInstance));
		EXPECT_EQ(instances.size(), 41u);
		return std::count_if(instances.begin() + 1, instances.end(), [](const RayInstance& instance) { return instance.structure != 0; });
	};
	EXPECT_GT(placed({}, true), 30);
	EXPECT_EQ(placed({ { "visible_clusters", 64 } }, false), 0);
}

}  // namespace tessera::test
