// Rays through pixels' centres see what the compute rasteriser sees; what they are traced through follows the demand.
#include "ray_frames.h"
#include "ray_test.h"

namespace tessera::test
{

namespace
{

using rays = RayTest;

}  // namespace

TEST_F(rays, primaryRaysSeeWhatTheComputeRasteriserSees)
{
	for (const char* name : { "planet", "bricks" })
	{
		const auto scene = gpuScene(name);
		expectSameVisibility(*scene, name, 5, camerasOf(*scene, 11, 6));
	}
}

TEST_F(rays, primaryRaysSeeMirroredShearedAndUntessellatedInstances)
{
	const GpuScene uneven(unevenScene());
	expectSameVisibility(uneven, "uneven instances", 6, camerasOf(uneven, 5, 3));
	expectSameVisibility(uneven, "uneven instances", 0, camerasOf(uneven, 6, 3));
}

// Back faces of single-sided materials are looked through, those of double-sided ones are not; in one scene both occur.
TEST_F(rays, primaryRaysKnowTheSidesOfMaterials)
{
	ImportedScene imported = soupScene(3, 60);
	imported.materials[0].double_sided = true;
	const GpuScene soup(imported);
	ASSERT_TRUE(soup.built.traits.has_single_sided && soup.built.traits.has_double_sided) << "the scene has only one kind";
	expectSameVisibility(soup, "soup", 8, camerasOf(soup, 2, 3));
	expectSameVisibility(soup, "soup", 0, camerasOf(soup, 3, 1));
}

TEST_F(rays, orthographicRaysToo)
{
	const auto scene = gpuScene("bricks");
	Camera camera = scene->camera;
	camera.orthographic = true;
	camera.height_world = boundingRadius(scene->built);
	expectSameVisibility(*scene, "bricks", 5, { { "orthographic", camera } });
}

TEST_F(rays, aReservationThatIsTooSmallIsMadeLargerInTheSameFrameAndNothingIsMissing)
{
	const auto scene = gpuScene("planet");
	const Camera far = closeTo(*scene, 30), near = closeTo(*scene, 0.5);
	const auto renderer = rendererOf(*scene, rayOptions(2, Raster::Rt)), fresh = rendererOf(*scene, rayOptions(2, Raster::Rt));
	ASSERT_TRUE(renderer && fresh);
	const Drawn before = drawnBy(*renderer, far), after = drawnBy(*renderer, near), expected = drawnBy(*fresh, near);
	const ListStats &small = listOf(before.result, "ray_geometry"), &large = listOf(after.result, "ray_geometry");
	ASSERT_GT(large.wanted, small.capacity) << "the near frame does not need more than the far one had";
	EXPECT_GT(after.result.attempts, 1u);
	EXPECT_LE(large.wanted, large.capacity);
	EXPECT_EQ(large.wanted, after.result.counts.micro_triangles);
	EXPECT_EQ(differingPixels(after.picture, expected.picture), 0u);
	// Once it is large enough, a frame is drawn once; after a small one it shrinks.
	EXPECT_EQ(drawnBy(*renderer, near).result.attempts, 1u);
	drawnBy(*renderer, far);
	EXPECT_LT(listOf(drawnBy(*renderer, far).result, "ray_geometry").capacity, large.capacity);
}

// Where every cluster is drawn as stored, what rays are traced through is refitted under a moving camera, and built again once something else than
// places changes. A refitted frame is the picture of a built one.
TEST_F(rays, refitsWhileNothingIsTessellatedAndBuildsWhenTheTopologyChanges)
{
	const auto scene = gpuScene("bricks");
	RenderOptions options = rayOptions(0, Raster::Rt);
	options.ray_sharing = false;
	const auto renderer = rendererOf(*scene, options);
	ASSERT_TRUE(renderer);
	drawnBy(*renderer, scene->camera);
	for (const double nearness : { 0.8, 0.5, 2.0 })
	{
		const Drawn moved = drawnBy(*renderer, closeTo(*scene, nearness)), built = drawnBy(*rendererOf(*scene, options), closeTo(*scene, nearness));
		EXPECT_TRUE(moved.result.rays.refitted) << nearness;
		EXPECT_FALSE(built.result.rays.refitted) << nearness;
		EXPECT_LE(differingPixels(moved.picture, built.picture), 2u) << nearness << ": more than ties";
	}
	RenderOptions other = options;
	other.rate = 6;
	ASSERT_TRUE(renderer->setOptions(other));
	EXPECT_FALSE(drawnBy(*renderer, scene->camera).result.rays.refitted) << "tessellated";
	EXPECT_FALSE(drawnBy(*renderer, scene->camera).result.rays.refitted) << "parts have no places of their own";
	ASSERT_TRUE(renderer->setOptions(options));
	EXPECT_FALSE(drawnBy(*renderer, scene->camera).result.rays.refitted) << "the first without tessellation";
	EXPECT_TRUE(drawnBy(*renderer, scene->camera).result.rays.refitted);
	other = options;
	other.displacement_scale = 0.5f;
	ASSERT_TRUE(renderer->setOptions(other));
	EXPECT_TRUE(drawnBy(*renderer, scene->camera).result.rays.refitted) << "only places changed";
	other.cull.frustum = true;
	ASSERT_TRUE(renderer->setOptions(other));
	EXPECT_FALSE(drawnBy(*renderer, scene->camera).result.rays.refitted) << "culled clusters are not there";
}

TEST_F(rays, repeatedFramesAreTheSameBits)
{
	const auto scene = gpuScene("bricks");
	RenderOptions options = rayOptions(5, Raster::Rt);
	options.shadows = true;
	options.ao_samples = 2;
	const auto renderer = rendererOf(*scene, options), other = rendererOf(*scene, options);
	ASSERT_TRUE(renderer && other);
	const Drawn first = drawnBy(*renderer, scene->camera);
	EXPECT_EQ(differingPixels(first.picture, drawnBy(*renderer, scene->camera).picture), 0u);
	EXPECT_EQ(differingPixels(first.picture, drawnBy(*other, scene->camera).picture), 0u);
}

// More clusters than the lists hold: each round has structures of its own, and the nearest of all rounds is seen.
TEST_F(rays, aSceneInRoundsIsSeenAsOne)
{
	const auto scene = gpuScene("instances:30", { 24, 16 });
	RenderOptions options = rayOptions(8, Raster::Rt);
	const Drawn whole = drawnBy(*rendererOf(*scene, options), scene->camera);
	options.capacities = { { "visible_clusters", 300 } };
	const Drawn parts = drawnBy(*rendererOf(*scene, options), scene->camera);
	EXPECT_GT(parts.result.rounds, 1u);
	EXPECT_EQ(whole.result.counts.covered_pixels, parts.result.counts.covered_pixels);
	EXPECT_EQ(differingPixels(whole.picture, parts.picture), 0u);
}

TEST_F(rays, lightThatNeedsWholeFramesRefusesRounds)
{
	const auto scene = gpuScene("instances:30", { 24, 16 });
	RenderOptions options = rayOptions(8, Raster::Soft);
	options.shadows = true;
	options.capacities = { { "visible_clusters", 300 } };
	const auto renderer = rendererOf(*scene, options);
	const auto result = renderer->renderFrame(scene->camera);
	ASSERT_FALSE(result);
	EXPECT_EQ(result.error().code, ExitCode::BadInput);
	EXPECT_NE(result.error().message.find("--capacity"), std::string::npos) << result.error().message;
}

}  // namespace tessera::test
