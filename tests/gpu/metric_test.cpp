// The metrics `detail` and `displaced` on the device: factors, splits and counts equal the CPU reference, bit for bit, as sets.
#include "gpu_test.h"
#include "scene/builtin.h"

namespace tessera::test
{

namespace
{

class metrics : public GpuTest, public testing::WithParamInterface<Metric>
{
protected:
	static BuildOptions build()
	{
		BuildOptions options;
		options.tables = MetricTables::of(GetParam());
		return options;
	}
	static RenderOptions uncut(float rate)
	{
		RenderOptions options = smallOptions(rate);
		options.cull = { false, false, false };
		options.metric = GetParam();
		return options;
	}
	static void expectAsReference(const GpuScene& scene, const RenderOptions& options, const Camera& camera, const std::string& what)
	{
		const GpuFrame frame = drawFrame(scene, options, camera);
		expectSameAsReference(frame, what);
		expectCovered(frame, what);
	}
};

}  // namespace

TEST_P(metrics, builtInScenesAreClassifiedAsByTheReference)
{
	for (const char* name : { "planet", "bricks" })
	{
		const auto scene = gpuScene(name, build());
		for (const float rate : { 4.0f })
			expectAsReference(*scene, uncut(rate), scene->camera, fmt::format("{} at rate {}", name, rate));
	}
}

TEST_P(metrics, closeCamerasSplitAsTheReferenceDoes)
{
	for (const auto& [name, max_split] : { std::pair{ "quad", 2u }, std::pair{ "terrain", 8u } })
	{
		const auto scene = gpuScene(name, build());
		RenderOptions options = uncut(3);
		options.max_split = max_split;
		expectAsReference(*scene, options, closeTo(*scene, 0.3), fmt::format("{} split by {}", name, max_split));
	}
}

TEST_P(metrics, seamyUnevenAndOrthographicScenesAreClassifiedAsByTheReference)
{
	// Every fourth: the CPU tests have them all.
	const std::vector<NamedScene> scenes = allScenes();
	for (size_t i = 0; i < scenes.size(); i += 4)
	{
		const NamedScene& named = scenes[i];
		const GpuScene scene(named.scene, defaultTable(), build());
		expectAsReference(scene, uncut(3), scene.camera, named.name);
	}
	const GpuScene uneven(unevenScene(), defaultTable(), build());
	RenderOptions scaled = uncut(3);
	scaled.displacement_scale = -2.5f;
	expectAsReference(uneven, scaled, uneven.camera, "uneven instances, displacement turned inwards");
	const auto bricks = gpuScene("bricks", build());
	Camera orthographic = bricks->camera;
	orthographic.orthographic = true;
	orthographic.height_world = boundingRadius(bricks->built) * 2;
	expectAsReference(*bricks, uncut(4), orthographic, "bricks, orthographic");
}

TEST_P(metrics, aListThatIsTooSmallCoarsensToWhatTheReferenceMakesOfThatRate)
{
	const auto scene = gpuScene("terrain", build());
	RenderOptions options = uncut(2);
	options.capacities["part_triangles"] = 1500;
	const GpuFrame frame = drawFrame(*scene, options, closeTo(*scene, 0.5));
	EXPECT_GT(frame.result.rate_granted, frame.result.rate_wanted);
	expectSameAsReference(frame, "coarsened");
	expectCovered(frame, "coarsened");
}

TEST_P(metrics, nothingIsTessellatedOrUploadedForDetailWhereNothingIsDisplaced)
{
	const GpuScene scene(squareScene(), defaultTable(), build());
	const GpuFrame frame = drawFrame(scene, uncut(1));
	const FramePlan& plan = frame.renderer->plan();
	EXPECT_FALSE(plan.keeps("triangle_details") || plan.keeps("edge_roughness"));
	EXPECT_EQ(plan.has("cluster_classify"), GetParam() == Metric::Displaced);
	if (GetParam() == Metric::Detail)
	{
		EXPECT_EQ(frame.result.counts.micro_triangles, 2u);
	}
}

INSTANTIATE_TEST_SUITE_P(detailAndDisplaced, metrics, testing::Values(Metric::Detail, Metric::Displaced),
						 [](const testing::TestParamInfo<Metric>& one) { return std::string(metricName(one.param)); });

}  // namespace tessera::test
