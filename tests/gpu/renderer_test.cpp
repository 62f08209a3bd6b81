// A renderer that lives on: frames that are polled, and options that change between frames.
#include "gpu/gpu_test.h"
#include "pipeline/passes.h"

#include <chrono>
#include <thread>

namespace tessera::test
{

namespace
{

using longLivedRenderer = GpuTest;

std::unique_ptr<Renderer> makeRenderer(const GpuScene& scene, const RenderOptions& options)
{
	auto made = Renderer::create(gpu(), scene.built, scene.table, framePasses(), options);
	EXPECT_TRUE(made.has_value()) << (made ? "" : made.error().message);
	return made ? std::move(*made) : nullptr;
}

FrameResult drawPolled(Renderer& renderer, const Camera& camera, const std::optional<Camera>& drawn_from = {})
{
	EXPECT_TRUE(renderer.beginFrame({ camera, drawn_from, {}, {} }).has_value());
	for (;;)
	{
		const auto result = renderer.pollFrame();
		EXPECT_TRUE(result.has_value());
		if (!result || *result)
			return result ? **result : FrameResult();
		std::this_thread::sleep_for(std::chrono::milliseconds(1));
	}
}

std::vector<uint8_t> pictureOf(Renderer& renderer)
{
	const auto picture = renderer.readPicture();
	EXPECT_TRUE(picture.has_value());
	return picture ? *picture : std::vector<uint8_t>();
}

// What the user may do to a running viewer, one after the other.
std::vector<RenderOptions> changingOptions()
{
	std::vector<RenderOptions> all = { smallOptions(4) };
	const auto then = [&](const auto& change) {
		all.push_back(all.back());
		change(all.back());
	};
	then([](RenderOptions& o) { o.view = ViewMode::Parts; });
	then([](RenderOptions& o) { o.width_px = 200, o.height_px = 70; });
	then([](RenderOptions& o) { o.raster = rasterPaths().front(); });
	then([](RenderOptions& o) { o.capacities["part_triangles"] = 40; });
	then([](RenderOptions& o) { o.capacities.clear(), o.rate = 0; });
	then([](RenderOptions& o) { o.rate = 2, o.view = ViewMode::Shaded; });
	then([](RenderOptions& o) { o.raster = rasterPaths().back(), o.displacement_scale = 0; });
	then([](RenderOptions& o) { o.displacement_scale = -1, o.smooth_normals = false; });
	then([](RenderOptions& o) { o.cull = { false, false, false }, o.lists_bytes = 4000000; });
	return all;
}

}  // namespace

TEST_F(longLivedRenderer, aPolledFrameEqualsOneThatIsWaitedFor)
{
	const auto scene = gpuScene("builtin:instances");
	RenderOptions options = smallOptions(3);
	options.capacities["visible_clusters"] = 64;  // drawn in rounds
	const auto waited = makeRenderer(*scene, options), polled = makeRenderer(*scene, options);
	const auto expected = waited->renderFrame(scene->camera);
	ASSERT_TRUE(expected.has_value());
	const FrameResult found = drawPolled(*polled, scene->camera);
	EXPECT_GT(found.rounds, 1u);
	EXPECT_EQ(found.rounds, expected->rounds);
	EXPECT_EQ(found.attempts, expected->attempts);
	EXPECT_EQ(found.counts.micro_triangles, expected->counts.micro_triangles);
	EXPECT_EQ(pictureOf(*polled), pictureOf(*waited));
}

TEST_F(longLivedRenderer, changedOptionsGiveThePictureOfARendererMadeWithThem)
{
	const auto scene = gpuScene("builtin:planet");
	const auto renderer = makeRenderer(*scene, smallOptions(4));
	size_t index = 0;
	for (const RenderOptions& options : changingOptions())
	{
		SCOPED_TRACE(index++);
		ASSERT_TRUE(renderer->setOptions(options).has_value());
		const FrameResult found = drawPolled(*renderer, scene->camera);
		const auto fresh = makeRenderer(*scene, options);
		const auto expected = fresh->renderFrame(scene->camera);
		ASSERT_TRUE(expected.has_value());
		EXPECT_EQ(found.coarsening, expected->coarsening);
		EXPECT_EQ(found.counts.micro_triangles, expected->counts.micro_triangles);
		EXPECT_EQ(pictureOf(*renderer), pictureOf(*fresh));
		EXPECT_EQ(renderer->memory().geometry, fresh->memory().geometry) << "something unneeded is kept, or something needed is missing";
	}
}

TEST_F(longLivedRenderer, aSecondCameraSeesWhatTheFirstIsTessellatedFor)
{
	const auto scene = gpuScene("builtin:planet");
	const Camera first = closeTo(*scene, 0.6);
	Camera second = scene->camera;
	second.eye = second.target + dvec3(glm::length(second.eye - second.target), 0, 0);
	for (Raster raster : rasterPaths())
	{
		SCOPED_TRACE(rasterName(raster));
		RenderOptions options = smallOptions(4);
		options.raster = raster;
		const auto renderer = makeRenderer(*scene, options);
		const FrameResult alone = drawPolled(*renderer, first);
		const std::vector<uint8_t> seen_alone = pictureOf(*renderer);
		const FrameResult same = drawPolled(*renderer, first, first);
		EXPECT_EQ(pictureOf(*renderer), seen_alone) << "the same camera twice is one camera";
		const FrameResult other = drawPolled(*renderer, first, second);
		EXPECT_EQ(other.counts.micro_triangles, alone.counts.micro_triangles);
		EXPECT_EQ(other.counts.visible_clusters, alone.counts.visible_clusters);
		EXPECT_EQ(same.counts.micro_triangles, alone.counts.micro_triangles);
		EXPECT_NE(pictureOf(*renderer), seen_alone);
		drawPolled(*renderer, first);
		EXPECT_EQ(pictureOf(*renderer), seen_alone) << "nothing of the second camera stays";
	}
}

TEST_F(longLivedRenderer, aSecondCameraSeesTheSurfaceWhereItIs)
{
	// Nothing is culled or cut, and heights do not depend on the distance: from the second camera it looks as if it were the only one.
	const auto scene = gpuScene("builtin:planet");
	Camera second = closeTo(*scene, 0.8);
	second.up = { 0.3, 1, 0.2 };
	for (Raster raster : rasterPaths())
	{
		SCOPED_TRACE(rasterName(raster));
		RenderOptions options = smallOptions(0);
		options.raster = raster;
		options.cull = { false, false, false };
		options.view = ViewMode::Triangles;
		const auto renderer = makeRenderer(*scene, options);
		drawPolled(*renderer, second);
		const std::vector<uint8_t> alone = pictureOf(*renderer);
		const FrameResult result = drawPolled(*renderer, scene->camera, second);
		EXPECT_GT(result.counts.covered_pixels, 3000u);
		EXPECT_LT(differingPixels(pictureOf(*renderer), alone, 8), 40u) << "but for pixels at edges, where positions are rounded otherwise";
	}
}

TEST_F(longLivedRenderer, optionsThatCannotBeLeaveTheOldOnes)
{
	const auto scene = gpuScene("builtin:planet");
	const auto renderer = makeRenderer(*scene, smallOptions(4));
	ASSERT_TRUE(renderer->renderFrame(scene->camera).has_value());
	const std::vector<uint8_t> before = pictureOf(*renderer);
	RenderOptions wrong = smallOptions(4);
	wrong.capacities["no_such_list"] = 1;
	EXPECT_FALSE(renderer->setOptions(wrong).has_value());
	wrong = smallOptions(4);
	wrong.width_px = 0;
	EXPECT_FALSE(renderer->setOptions(wrong).has_value());
	ASSERT_TRUE(renderer->renderFrame(scene->camera).has_value());
	EXPECT_EQ(pictureOf(*renderer), before);
}

}  // namespace tessera::test
