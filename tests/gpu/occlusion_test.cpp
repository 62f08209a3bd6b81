// Occlusion culling: what is hidden is left out, and no pixel changes, however the camera moves. Pictures are taken in the view
// that colours micro-triangles by their identity, so that they compare who is seen.
#include "gpu_test.h"

#include "pipeline/passes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <random>

namespace tessera::test
{

namespace
{

using occlusion = GpuTest;

RenderOptions softOptions(float rate, bool culls)
{
	RenderOptions options = smallOptions(rate);
	options.raster = Raster::Soft;
	// Large enough for boxes on screen to span several texels of the pyramid.
	options.width_px = 320;
	options.height_px = 180;
	options.view = ViewMode::Triangles;
	options.cull = { culls, culls, culls };
	return options;
}

// Cameras that stand, creep, jump and turn round, around and inside the scene.
std::vector<Camera> restlessCameras(const GpuScene& scene, uint32_t count)
{
	std::mt19937 random(7);
	const auto signedUnit = [&] {
		return std::uniform_real_distribution<double>(-1, 1)(random);
	};
	const dvec3 middle = (scene.built.world_low + scene.built.world_high) / 2.0;
	const double reach = boundingRadius(scene.built);
	std::vector<Camera> cameras;
	for (uint32_t i = 0; i < count; ++i)
	{
		Camera camera = cameras.empty() ? scene.camera : cameras.back();
		if (i % 4 == 1)
			camera.eye += dvec3(signedUnit(), signedUnit(), signedUnit()) * reach * 0.02;
		if (i % 4 == 2)
			camera = squareCamera(middle + dvec3(signedUnit(), signedUnit(), signedUnit()) * reach * 1.2, middle);
		if (i % 4 == 3)
			camera = squareCamera(camera.eye, camera.eye + dvec3(signedUnit(), signedUnit(), signedUnit()) * reach);
		camera.near_world = reach * 0.01;
		cameras.push_back(camera);
	}
	return cameras;
}

size_t differing(const GpuFrame& a, const GpuFrame& b)
{
	const std::vector<uint8_t> first = a.picture(), second = b.picture();
	size_t count = 0;
	for (size_t i = 0; i < first.size(); i += 4)
		count += std::memcmp(&first[i], &second[i], 4) != 0 ? 1 : 0;
	return count;
}

bool hasSoftPath()
{
	const std::vector<Raster> paths = rasterPaths();
	return std::find(paths.begin(), paths.end(), Raster::Soft) != paths.end();
}

}  // namespace

TEST_F(occlusion, noPixelChangesUnderACameraThatStandsCreepsJumpsAndTurns)
{
	if (!hasSoftPath())
		GTEST_SKIP() << "the device lacks 64-bit buffer atomics";
	for (const auto& [name, rate] : { std::pair{ "instances:60", 1.5f }, { "bricks", 2.0f }, { "planet", 0.0f } })
	{
		const auto scene = gpuScene(name);
		const std::vector<Camera> cameras = restlessCameras(*scene, 14);
		GpuFrame culled = drawFrame(*scene, softOptions(rate, true), cameras[0]);
		GpuFrame whole = drawFrame(*scene, softOptions(rate, false), cameras[0]);
		uint64_t hidden = 0, revealed = 0;
		for (size_t i = 0; i < cameras.size(); ++i)
		{
			if (i > 0)
			{
				drawAgain(culled, cameras[i]);
				drawAgain(whole, cameras[i]);
			}
			EXPECT_EQ(culled.result.counts.covered_pixels, whole.result.counts.covered_pixels) << name << " frame " << i;
			// Surfaces at exactly the same depth may resolve either way.
			EXPECT_LE(differing(culled, whole), whole.result.counts.covered_pixels / 500 + 1) << name << " frame " << i;
			hidden += culled.result.counts.hidden_parts;
			revealed += culled.result.counts.revealed_parts;
		}
		EXPECT_TRUE(rate == 0 || hidden > 0) << name;
		EXPECT_TRUE(rate == 0 || revealed > 0) << name << ": no camera needed the second phase";
	}
}

TEST_F(occlusion, whatAWallHidesIsLeftOutAndStillCounted)
{
	if (!hasSoftPath())
		GTEST_SKIP() << "the device lacks 64-bit buffer atomics";
	// A planet behind another, seen so that the near one covers the far one.
	const auto scene = gpuScene("planet");
	BuiltScene two = scene->built;
	Camera camera = scene->camera;
	const dvec3 away = glm::normalize(camera.target - camera.eye);
	two.instances.push_back(two.instances[0]);
	two.instances[1].world = glm::translate(dmat4(1), away * boundingRadius(scene->built) * 4.0) * two.instances[0].world;

	RenderOptions options = softOptions(1.5f, true);
	auto renderer = Renderer::create(gpu(), two, scene->table, framePasses(), options);
	ASSERT_TRUE(renderer.has_value()) << renderer.error().message;
	FrameResult first, second;
	for (FrameResult* frame : { &first, &second })
	{
		Result<FrameResult> drawn = (*renderer)->renderFrame(camera);
		ASSERT_TRUE(drawn.has_value()) << drawn.error().message;
		*frame = *drawn;
	}
	EXPECT_EQ(first.counts.hidden_parts, 0u) << "there is no frame before the first";
	EXPECT_GT(second.counts.hidden_parts, second.counts.part_triangles / 3);
	EXPECT_EQ(second.counts.revealed_parts, 0u) << "the camera stands still";
	EXPECT_EQ(second.counts.part_triangles, first.counts.part_triangles) << "the rate must not depend on what is hidden";
	EXPECT_EQ(second.counts.micro_triangles, first.counts.micro_triangles);
	EXPECT_EQ(second.counts.covered_pixels, first.counts.covered_pixels);
}

TEST_F(occlusion, fullClustersWaitForTheSecondPhaseToo)
{
	if (!hasSoftPath())
		GTEST_SKIP() << "the device lacks 64-bit buffer atomics";
	const auto scene = gpuScene("planet");
	GpuFrame frame = drawFrame(*scene, softOptions(0, true), scene->camera);
	const auto countPhase = [&](uint32_t phase) {
		size_t count = 0;
		for (const FullCluster& full : frame.read<FullCluster>("full_clusters"))
			count += full.phase == phase ? 1 : 0;
		return count;
	};
	EXPECT_EQ(countPhase(PHASE_HIDDEN), 0u);
	const uint64_t covered = frame.result.counts.covered_pixels;
	drawAgain(frame, scene->camera);
	EXPECT_GT(countPhase(PHASE_HIDDEN), 0u);
	EXPECT_EQ(countPhase(PHASE_SECOND), 0u);
	EXPECT_EQ(frame.result.counts.covered_pixels, covered);
	// From the other side, what hid is hidden: nothing may be missing.
	Camera turned = scene->camera;
	turned.eye = turned.target * 2.0 - turned.eye;
	drawAgain(frame, turned);
	EXPECT_GT(countPhase(PHASE_SECOND), 0u);
	const GpuFrame whole = drawFrame(*scene, softOptions(0, false), turned);
	EXPECT_EQ(frame.result.counts.covered_pixels, whole.result.counts.covered_pixels);
	EXPECT_LE(differing(frame, whole), covered / 500 + 1);
}

}  // namespace tessera::test
