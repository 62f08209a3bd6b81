#include "ray_frames.h"

#include "ray_test.h"

#include "verify/frame_source.h"
#include "verify/paths_check.h"
#include "verify/screen.h"

#include "pipeline/passes.h"

namespace tessera::test
{

namespace
{

std::unique_ptr<verify::FrameSource> sourceOf(const GpuScene& scene, const RenderOptions& options, bool with_micro)
{
	auto source = verify::FrameSource::create(gpu(), scene.host, scene.built, scene.table, options, with_micro, {}, 1);
	EXPECT_TRUE(source) << (source ? "" : source.error().message);
	return source ? std::move(*source) : nullptr;
}

verify::Capture captured(verify::FrameSource& source, const Camera& camera, float rate)
{
	auto capture = source.capture(camera, rate);
	EXPECT_TRUE(capture) << (capture ? "" : capture.error().message);
	return capture ? std::move(*capture) : verify::Capture();
}

}  // namespace

std::unique_ptr<Renderer> rendererOf(const GpuScene& scene, const RenderOptions& options)
{
	auto renderer = Renderer::create(gpu(), scene.built, scene.table, framePasses(), options);
	EXPECT_TRUE(renderer) << (renderer ? "" : renderer.error().message);
	return renderer ? std::move(*renderer) : nullptr;
}

Drawn drawnBy(Renderer& renderer, const Camera& camera)
{
	Drawn drawn;
	auto result = renderer.renderFrame(camera);
	auto picture = renderer.readPicture();
	EXPECT_TRUE(result && picture) << (result ? "" : result.error().message);
	if (result && picture)
		drawn = { std::move(*result), std::move(*picture) };
	return drawn;
}

const ListStats& listOf(const FrameResult& result, std::string_view name)
{
	static const ListStats kNone;
	const auto found = std::find_if(result.lists.begin(), result.lists.end(), [&](const ListStats& list) { return list.name == name; });
	EXPECT_NE(found, result.lists.end()) << name;
	return found == result.lists.end() ? kNone : *found;
}

uint64_t expectSameVisibility(const GpuScene& scene, const std::string& name, RenderOptions options, const std::vector<verify::NamedCamera>& cameras)
{
	const float rate = options.rate;
	options.raster = Raster::Soft;
	const auto soft = sourceOf(scene, options, true);
	options.raster = Raster::Rt;
	const auto rt = sourceOf(scene, options, false);
	EXPECT_TRUE(soft && rt) << name;
	if (!soft || !rt)
		return 0;
	uint64_t covered = 0, differ = 0, shared = 0;
	for (const verify::NamedCamera& camera : cameras)
	{
		const std::string what = fmt::format("{} at rate {}, camera {}", name, rate, camera.name);
		const verify::Capture expected = captured(*soft, camera.camera, rate), found = captured(*rt, camera.camera, rate);
		verify::CheckResult check =
			verify::checkPaths(verify::Screen(scene.host, expected.view), expected.micro, expected.visible, found.visible, "rt");
		EXPECT_EQ(check.violations, 0u) << what << ": " << verify::describe(check.place);
		EXPECT_EQ(expected.result.counts.micro_triangles, found.result.counts.micro_triangles) << what;
		covered += expected.visible.covered();
		differ += check.sums["pixels that differ"];
		shared += found.result.rays.shared_instances;
	}
	EXPECT_GT(covered, cameras.size() * 96 * 54 / 20) << name << ": too little is seen";
	EXPECT_LE(differ * 50, covered) << name;
	return shared;
}

uint64_t expectSameVisibility(const GpuScene& scene, const std::string& name, float rate, const std::vector<verify::NamedCamera>& cameras)
{
	return expectSameVisibility(scene, name, rayOptions(rate, Raster::Rt), cameras);
}

std::vector<verify::NamedCamera> camerasOf(const GpuScene& scene, uint64_t seed, uint32_t count)
{
	std::vector<verify::NamedCamera> cameras = verify::randomCameras(scene.built, seed, count);
	cameras.push_back({ "its own", scene.camera });
	return cameras;
}

}  // namespace tessera::test
