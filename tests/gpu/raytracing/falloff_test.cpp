// --ray-falloff on the device: factors as the reference's, the picture's own triangles untouched, shadows nearly so, fewer triangles out of view.
#include "gpu/visibility.h"
#include "ray_test.h"

namespace tessera::test
{

namespace
{

using falloff = RayTest;

RenderOptions shadowed(float rate, float ray_falloff)
{
	RenderOptions options = rayOptions(rate, Raster::Soft);
	options.shadows = true;
	options.ray_falloff = ray_falloff;
	return options;
}

// In the middle of the scene, looking level.
Camera within(const GpuScene& scene)
{
	const dvec3 low = scene.built.world_low, high = scene.built.world_high, middle = (low + high) / 2.0;
	Camera camera = squareCamera(middle, middle + dvec3(1, -0.1, 0.4) * boundingRadius(scene.built));
	camera.fov_y_rad = 0.8;
	return camera;
}

uint64_t microTriangles(const GpuFrame& frame)
{
	return frame.result.counts.micro_triangles;
}

}  // namespace

TEST_F(falloff, factorsAreTheReferencesBitForBit)
{
	struct Case
	{
		const char* scene;
		Metric metric;
		float rate;
		uint32_t max_split;
	};
	for (const Case& c : { Case{ "instances:8", Metric::Edge, 0.7f, 2 }, Case{ "planet", Metric::Detail, 2, 8 } })
	{
		BuildOptions build;
		build.tables = MetricTables::of(c.metric);
		const auto scene = gpuScene(c.scene, build);
		RenderOptions options = shadowed(c.rate, 6);
		options.metric = c.metric;
		options.max_split = c.max_split;
		const GpuFrame frame = drawFrame(*scene, options, within(*scene));
		const std::string what = fmt::format("{} by {}", c.scene, metricName(c.metric));
		EXPECT_GT(frame.view().unseen_growth, 0) << what;
		expectSameAsReference(frame, what);
		expectCovered(frame, what);
		EXPECT_TRUE(c.max_split > 2 || !frame.splits.empty()) << what;
	}
}

// A frame that does not fit is coarsened with the same falloff.
TEST_F(falloff, aListThatIsTooSmallCoarsensToWhatTheReferenceMakesOfThatRate)
{
	const auto scene = gpuScene("instances:24");
	RenderOptions options = shadowed(2, 6);
	const GpuFrame roomy = drawFrame(*scene, options, within(*scene));
	options.capacities = { { "part_triangles", uint32_t(roomy.parts.size() * 2 / 3) } };
	const GpuFrame tight = drawFrame(*scene, options, within(*scene));
	EXPECT_GT(tight.result.rate_granted, tight.result.rate_wanted);
	expectSameAsReference(tight, "two thirds of the parts");
	expectCovered(tight, "two thirds of the parts");
}

TEST_F(falloff, everyPixelSeesTheSameMicroTriangleOfFewer)
{
	const auto scene = gpuScene("instances:60");
	const Camera camera = within(*scene);
	RenderOptions options = shadowed(2, 0);
	options.raster = drawingPaths().front();
	const GpuFrame whole = drawFrame(*scene, options, camera);
	options.ray_falloff = 8;
	const GpuFrame falling = drawFrame(*scene, options, camera);
	const std::vector<VisiblePixel> expected = visibilityOf(whole), found = visibilityOf(falling);
	ASSERT_FALSE(expected.empty());
	const VisibilityDifference difference = compareVisibility(expected, found, options.width_px);
	EXPECT_EQ(difference.others, 0u) << difference.first;
	EXPECT_GT(difference.covered, 500u);
	EXPECT_LT(microTriangles(falling), microTriangles(whole) * 4 / 5);
	EXPECT_LT(falling.list("ray_geometry").wanted, whole.list("ray_geometry").wanted * 4 / 5);
}

// A bumpy ball above and beside the view throws its shadow onto the floor in view: by default its outline hardly moves.
TEST_F(falloff, theShadowOfWhatIsOutOfViewHardlyMoves)
{
	ImportedScene imported = sphereScene(8, 16, TexelFormat::U8, Wrap::Repeat);
	const dvec3 sun(0.4867, 0.6489, 0.5849);  // shaders/lib/lighting.glsl
	imported.instances[0].world[3] = dvec4(dvec3(0, 0, 0.4) + sun * (4 / sun.y), 1);
	Primitive floor;
	floor.material = addPlain(imported, "floor");
	imported.materials.back().double_sided = true;
	for (const vec3 corner : { vec3(-6, 0, 6), vec3(6, 0, 6), vec3(6, 0, -6), vec3(-6, 0, -6) })
		addVertex(floor, corner, vec3(0, 1, 0), vec2(0));
	addTriangle(floor, 0, 1, 2);
	addTriangle(floor, 0, 2, 3);
	addPlacedMesh(imported, { floor });
	const GpuScene scene(imported);
	const Camera camera = squareCamera(dvec3(0.3, 1.6, 0.9), dvec3(0, 0, 0.4));

	RenderOptions options = rayOptions(1, Raster::Soft);
	const GpuFrame unlit = drawFrame(scene, options, camera);
	const GpuFrame whole = drawFrame(scene, shadowed(1, 0), camera), falling = drawFrame(scene, shadowed(1, options.ray_falloff), camera);
	const size_t dark = differingPixels(unlit.picture(), whole.picture(), 8), differing = differingPixels(whole.picture(), falling.picture(), 8);
	RecordProperty("pixels", fmt::format("{} dark, {} differ", dark, differing));
	// The floor, in view, has most of them.
	EXPECT_LT(microTriangles(falling) + 500, microTriangles(whole));
	EXPECT_GT(dark, 500u) << "no shadow falls into the picture";
	EXPECT_LT(differing, dark / 50);
}

// Nothing of it where no light's rays are traced.
TEST_F(falloff, isNotThereWithoutRaysOfLight)
{
	const auto scene = gpuScene("bricks");
	RenderOptions options = rayOptions(6, Raster::Soft);
	ASSERT_GT(options.ray_falloff, 0);
	const GpuFrame frame = drawFrame(*scene, options);
	EXPECT_EQ(frame.view().unseen_growth, 0);
}

}  // namespace tessera::test
