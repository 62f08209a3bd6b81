// --force: whatever is kept though nothing needs it, the picture and the counts stay as they are, bit for bit.
#include "gpu_test.h"

#include "frame/frame_resources.h"
#include "pipeline/passes.h"
#include "plan/forced.h"

namespace tessera::test
{

namespace
{

class force : public GpuTest
{
};

// Everything that the renderer's last frame leaves out and that can be forced.
std::vector<std::string> forceable(const Renderer& renderer)
{
	std::vector<std::string> names;
	for (const std::string_view name : forceNames(framePasses(), resourceDescs()))
	{
		const std::string one[] = { std::string(name) };
		const auto forced = forcedBy(one, framePasses(), resourceDescs(), kWantedOutputs, renderer.planInput());
		if (forced && !forced->empty())
			names.push_back(one[0]);
	}
	return names;
}

size_t forcedThings(const FramePlan& plan)
{
	return plan.forced.size() + size_t(std::count_if(plan.features.begin(), plan.features.end(), [](const Feature& f) { return f.forced; })) +
		   size_t(std::count_if(plan.resources.begin(), plan.resources.end(), [](const PlannedResource& r) { return r.forced; }));
}

void expectSameCounts(const FrameCountsRead& a, const FrameCountsRead& b)
{
	EXPECT_EQ(a.micro_triangles, b.micro_triangles);
	EXPECT_EQ(a.part_triangles, b.part_triangles);
	EXPECT_EQ(a.split_triangles, b.split_triangles);
	EXPECT_EQ(a.full_clusters, b.full_clusters);
	EXPECT_EQ(a.covered_pixels, b.covered_pixels);
}

// Two frames each: the second has a past to look for hidden things in. Gives how many things were forced.
size_t expectSamePicture(const GpuScene& scene, const RenderOptions& options, const Camera& camera, const std::string& what)
{
	SCOPED_TRACE(what);
	auto made = Renderer::create(gpu(), scene.built, scene.table, framePasses(), options);
	EXPECT_TRUE(made) << (made ? "" : made.error().message);
	if (!made)
		return 0;
	Renderer& renderer = **made;
	const auto draw = [&](std::vector<uint8_t>& picture) {
		FrameResult last;
		for (int frame = 0; frame < 2; ++frame)
		{
			const auto result = renderer.renderFrame(camera);
			EXPECT_TRUE(result) << (result ? "" : result.error().message);
			if (result)
				last = *result;
		}
		picture = *renderer.readPicture();
		return last;
	};
	std::vector<uint8_t> plain, with_more;
	const FrameResult before = draw(plain);
	EXPECT_EQ(forcedThings(renderer.plan()), 0u);
	RenderOptions all = options;
	all.forced = forceable(renderer);
	const Status set = renderer.setOptions(all);
	EXPECT_TRUE(set) << (set ? "" : set.error().message);
	const FrameResult after = draw(with_more);
	expectSameCounts(before.counts, after.counts);
	EXPECT_TRUE(plain == with_more) << "the picture differs";
	return forcedThings(renderer.plan());
}

class forceBuiltIn : public force, public testing::WithParamInterface<const char*>
{
};

}  // namespace

TEST_P(forceBuiltIn, everythingForcedAtOnceChangesNothing)
{
	const auto scene = gpuScene(GetParam());
	RenderOptions options = smallOptions(4);
	options.raster = Raster::Auto;
	EXPECT_GT(expectSamePicture(*scene, options, scene->camera, GetParam()), 5u);
}

INSTANTIATE_TEST_SUITE_P(all, forceBuiltIn,
						 testing::Values("planet", "showcase:20", "terrain", "bricks", "instances:40", "quad", "cube", "materials"),
						 [](const testing::TestParamInfo<const char*>& one) {
							 const std::string_view name = one.param;
							 return std::string(name.substr(0, name.find(':')));
						 });

TEST_F(force, displacementOfNothingChangesNothing)
{
	const GpuScene flat(squareScene());
	EXPECT_GT(expectSamePicture(flat, smallOptions(4), flat.camera, "a flat square"), 15u);
}

TEST_F(force, classifyingAndSplittingWhatIsNotTessellatedChangesNothing)
{
	const auto scene = gpuScene("cube");
	RenderOptions options = smallOptions(1000);
	auto made = Renderer::create(gpu(), scene->built, scene->table, framePasses(), options);
	ASSERT_TRUE(made);
	ASSERT_TRUE((*made)->renderFrame(scene->camera));
	ASSERT_FALSE((*made)->plan().has("cluster_classify"));
	const auto plain = (*made)->readPicture();
	options.forced = { "triangle_split", "cluster_classify" };
	ASSERT_TRUE((*made)->setOptions(options));
	ASSERT_TRUE((*made)->renderFrame(scene->camera));
	EXPECT_TRUE((*made)->plan().has("cluster_classify") && (*made)->plan().has("triangle_split") && (*made)->plan().has("batch_parts"));
	EXPECT_TRUE(*plain == *(*made)->readPicture());
}

TEST_F(force, drawingPathsStayTheSameToo)
{
	const auto scene = gpuScene("materials");
	for (const Raster raster : drawingPaths())
	{
		RenderOptions options = smallOptions(6);
		options.raster = raster;
		expectSamePicture(*scene, options, scene->camera, std::string(rasterName(raster)));
	}
}

}  // namespace tessera::test
