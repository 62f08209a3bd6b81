// The kernel for small triangles: who is seen does not depend on whether it is used, and what it cannot do is left to raster_micro.
// It is off on processors, so these tests switch it themselves.
#include "gpu_test.h"

#include <algorithm>
#include <tuple>

namespace tessera::test
{

namespace
{

using smallFirst = GpuTest;

// The device with or without the kernel, until the end of the scope.
struct WithKernel
{
	explicit WithKernel(bool on) { gpu().limits.most_small_rate_px = on ? 16.0f : 0.0f; }
	~WithKernel() { gpu().limits.most_small_rate_px = before; }
	WithKernel(const WithKernel&) = delete;
	WithKernel& operator=(const WithKernel&) = delete;
	float before = gpu().limits.most_small_rate_px;
};

GpuFrame drawWith(bool kernel, const GpuScene& scene, const RenderOptions& options, const Camera& camera)
{
	const WithKernel scope(kernel);
	return drawFrame(scene, options, camera);
}

RenderOptions softOptions(float rate)
{
	RenderOptions options = smallOptions(rate);
	options.raster = Raster::Soft;
	options.view = ViewMode::Triangles;
	return options;
}

bool hasSoftPath()
{
	const std::vector<Raster> paths = rasterPaths();
	return std::find(paths.begin(), paths.end(), Raster::Soft) != paths.end();
}

uint32_t leftItems(const GpuFrame& frame)
{
	return frame.read<FrameCounts>("counts").at(0).left_items;
}

uint64_t itemsOf(const GpuFrame& frame)
{
	return frame.read<Batch>("batches").size() + frame.read<FullCluster>("full_clusters").size();
}

// Exactly equal depths may fall either way.
void expectSamePictures(const GpuFrame& with, const GpuFrame& without, const std::string& what)
{
	EXPECT_EQ(with.result.counts.covered_pixels, without.result.counts.covered_pixels) << what;
	EXPECT_LE(differingPixels(with.picture(), without.picture()), without.result.counts.covered_pixels / 1000) << what;
}

// Into the scene, so that triangles cross the near plane and stand far beyond the picture's sides.
Camera within(const GpuScene& scene)
{
	const dvec3 middle = (scene.built.world_low + scene.built.world_high) / 2.0;
	Camera camera = scene.camera;
	camera.eye = middle + (scene.camera.eye - middle) * 0.05;
	camera.target = middle + dvec3(1, 0.3, 0.2) * boundingRadius(scene.built);
	camera.near_world = boundingRadius(scene.built) * 1e-4;
	return camera;
}

// Workgroups of compute passes with so many threads, until the end of the scope.
struct WithThreads
{
	explicit WithThreads(uint32_t count) { gpu().limits.compute_workgroup_threads = count; }
	~WithThreads() { gpu().limits.compute_workgroup_threads = before; }
	WithThreads(const WithThreads&) = delete;
	WithThreads& operator=(const WithThreads&) = delete;
	uint32_t before = gpu().limits.compute_workgroup_threads;
};

GpuFrame drawWithThreads(uint32_t threads, const GpuScene& scene, const RenderOptions& options, const Camera& camera)
{
	const WithThreads scope(threads);
	return drawFrame(scene, options, camera);
}

}  // namespace

TEST_F(smallFirst, theKernelForSmallTrianglesChangesNoPixelAndLeavesNothingThatItCanDo)
{
	if (!hasSoftPath())
		GTEST_SKIP() << "the device lacks 64-bit buffer atomics";
	for (const char* name : { "planet", "instances:30" })
	{
		const auto scene = gpuScene(name);
		const GpuFrame with = drawWith(true, *scene, softOptions(2), scene->camera);
		ASSERT_GT(itemsOf(with), 0u) << name;
		EXPECT_EQ(leftItems(with), 0u) << name << ": all of it is in view and small";
		expectSamePictures(with, drawWith(false, *scene, softOptions(2), scene->camera), name);
	}
}

TEST_F(smallFirst, whatCrossesTheNearPlaneOrIsLargeIsLeftAndStillDrawn)
{
	if (!hasSoftPath())
		GTEST_SKIP() << "the device lacks 64-bit buffer atomics";
	uint64_t left = 0, items = 0;
	for (const char* name : { "bricks", "instances:30", "materials" })
	{
		const auto scene = gpuScene(name);
		const Camera camera = within(*scene);
		const GpuFrame with = drawWith(true, *scene, softOptions(6), camera);
		expectSamePictures(with, drawWith(false, *scene, softOptions(6), camera), name);
		left += leftItems(with);
		items += itemsOf(with);
	}
	EXPECT_GT(left, 0u);
	EXPECT_LT(left, items);
}

// Steep sides make triangles that are far longer than the rate: too large for one lane, though no vertex is outside.
TEST_F(smallFirst, trianglesThatDisplacementStretchesAreLeft)
{
	if (!hasSoftPath())
		GTEST_SKIP() << "the device lacks 64-bit buffer atomics";
	const auto scene = gpuScene("bricks");
	RenderOptions options = softOptions(6);
	options.width_px = options.height_px = 256;
	options.displacement_scale = 40;
	const GpuFrame with = drawWith(true, *scene, options, scene->camera);
	EXPECT_GT(leftItems(with), 0u);
	expectSamePictures(with, drawWith(false, *scene, options, scene->camera), "stretched bricks");
}

// Two phases: the second takes all items itself, and none of the first's leftovers.
TEST_F(smallFirst, underOcclusionCullingNoPixelChangesWhenTheCameraJumps)
{
	if (!hasSoftPath())
		GTEST_SKIP() << "the device lacks 64-bit buffer atomics";
	const WithKernel scope(true);
	uint64_t revealed = 0, left = 0;
	for (const auto& [name, rate, scale] : { std::tuple{ "instances:60", 2.0f, 1.0f }, { "bricks", 6.0f, 40.0f } })
	{
		const auto scene = gpuScene(name);
		RenderOptions options = softOptions(rate);
		options.displacement_scale = scale;
		GpuFrame culled = drawFrame(*scene, options);
		options.cull = { false, false, false };
		GpuFrame whole = drawFrame(*scene, options);
		for (const double turn : { 0.0, 0.02, 0.7, -0.4 })
		{
			Camera camera = within(*scene);
			camera.target += dvec3(-turn, turn * 0.3, turn) * boundingRadius(scene->built);
			drawAgain(culled, camera);
			drawAgain(whole, camera);
			EXPECT_EQ(culled.result.counts.covered_pixels, whole.result.counts.covered_pixels) << name << turn;
			EXPECT_LE(differingPixels(culled.picture(), whole.picture()), whole.result.counts.covered_pixels / 500 + 1) << name << turn;
			revealed += culled.result.counts.revealed_parts;
			left += leftItems(culled);
		}
	}
	EXPECT_GT(revealed, 0u);
	EXPECT_GT(left, 0u);
}

// Few items and large triangles: raster_micro gives an item to several workgroups, and a triangle's rows to several lanes, where workgroups are as
// large as a GPU's.
TEST_F(smallFirst, sharingItemsAndRowsChangesNoPixel)
{
	if (!hasSoftPath())
		GTEST_SKIP() << "the device lacks 64-bit buffer atomics";
	for (const auto& [name, rate] : { std::pair{ "bricks", 0.0f }, { "instances:30", 8.0f } })
	{
		const auto scene = gpuScene(name);
		for (const Camera& camera : { scene->camera, within(*scene) })
			expectSamePictures(drawWithThreads(256, *scene, softOptions(rate), camera), drawWithThreads(32, *scene, softOptions(rate), camera), name);
	}
}

}  // namespace tessera::test
