// planFrame over the passes there are: what is kept, what is left out and why.
#include "plan_checks.h"

#include "plan/conditions.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessera::test
{

TEST(framePlan, aSceneThatNeedsEverythingGetsIt)
{
	const PlanInput input = fullInput();
	const FramePlan plan = planOf(input);
	for (const char* pass : { "frame_begin", "instance_classify", "cluster_cull", "cluster_classify", "triangle_split", "batch_parts",
							  "draw_clusters", "draw_batches", "shade" })
		EXPECT_TRUE(plan.has(pass)) << pass;
	expectKept(plan, { "height_texels", "uvs", "seam_edges", "color_textures", "colors", "part_triangles", "patterns" });
	for (const char* feature : { "HAS_DISPLACEMENT", "HAS_SEAMS", "HAS_TESSELLATION", "HAS_COLOR_TEXTURES", "HAS_VERTEX_COLORS", "HAS_SMOOTH_NORMALS",
								 "HAS_CULLING", "HAS_MIXED_SIDES", "HAS_MIRRORED_INSTANCES", "HAS_SINGLE_SIDED", "IS_SHADED_VIEW" })
		EXPECT_TRUE(featureOn(plan, feature)) << feature;
	for (const Feature& feature : plan.features)
		EXPECT_EQ(feature.on, feature.reason.empty()) << feature.name;
}

// Cutting off back faces before corners are rounded opens holes between slivers (conditions.h).
TEST(framePlan, fragmentsTellSidesWhereMeshShadersRunOnAProcessor)
{
	PlanInput input = fullInput();
	input.options.raster = Raster::Mesh;
	input.scene.has_double_sided = false;
	input.device.is_cpu = true;
	EXPECT_TRUE(featureOn(planOf(input), "SIDES_IN_FRAGMENTS"));
	input.scene.has_double_sided = true;
	EXPECT_FALSE(featureOn(planOf(input), "SIDES_IN_FRAGMENTS")) << "materials tell them anyway";
	input.scene.has_double_sided = false;
	input.device.is_cpu = false;
	EXPECT_FALSE(featureOn(planOf(input), "SIDES_IN_FRAGMENTS"));
}

TEST(framePlan, tableBytesAreThoseOfTheTable)
{
	PlanInput input = fullInput();
	input.sizes.patterns = 10;
	input.sizes.table_vertices = 100;
	input.sizes.table_triangles = 1000;
	const FramePlan plan = planOf(input);
	EXPECT_EQ(resourceOf(plan, "patterns").bytes, 160u);
	EXPECT_EQ(resourceOf(plan, "table_vertices").bytes, 400u);
	EXPECT_EQ(resourceOf(plan, "table_triangles").bytes, 4000u);
}

TEST(framePlan, withoutDisplacementNothingOfItIsHeld)
{
	PlanInput input = fullInput();
	input.scene.has_displacement = false;
	const FramePlan plan = planOf(input);
	expectLeftOut(plan, { "height_texels", "height_maps", "material_height_maps", "uvs", "densities", "directions", "seam_edges", "seam_corners",
						  "first_seam_edges", "seam_corner_indices" });
	EXPECT_FALSE(featureOn(plan, "HAS_DISPLACEMENT"));
	EXPECT_FALSE(featureOn(plan, "HAS_SEAMS"));
}

TEST(framePlan, aDisplacementScaleOfZeroIsAsGoodAsNone)
{
	PlanInput input = fullInput();
	input.options.displacement_scale = 0;
	EXPECT_FALSE(planOf(input).keeps("height_texels"));
}

TEST(framePlan, withoutSeamsNothingOfThemIsHeld)
{
	PlanInput input = fullInput();
	input.scene.seam_edges = input.scene.seam_corners = 0;
	const FramePlan plan = planOf(input);
	expectLeftOut(plan, { "seam_edges", "seam_corners", "first_seam_edges", "seam_corner_indices" });
	expectKept(plan, { "height_texels", "uvs" });
	EXPECT_FALSE(featureOn(plan, "HAS_SEAMS"));
	EXPECT_TRUE(featureOn(plan, "HAS_DISPLACEMENT"));
}

TEST(framePlan, pnTrianglesAloneKeepDirectionsAndNothingElseOfDisplacement)
{
	PlanInput input = fullInput();
	EXPECT_FALSE(featureOn(planOf(input), "HAS_PN"));
	input.scene.has_displacement = false;
	input.scene.has_pn = true;
	const FramePlan plan = planOf(input);
	EXPECT_TRUE(featureOn(plan, "HAS_PN"));
	EXPECT_FALSE(featureOn(plan, "HAS_DISPLACEMENT"));
	expectKept(plan, { "directions" });
	expectLeftOut(plan, { "height_texels", "height_maps", "uvs", "densities", "seam_edges", "triangle_reaches" });
	input.options.metric = Metric::Detail;
	expectKept(planOf(input), { "triangle_details" });
	EXPECT_TRUE(planOf(input).has("cluster_classify"));
	input.options.rate = 0;
	EXPECT_FALSE(featureOn(planOf(input), "HAS_PN"));
	expectLeftOut(planOf(input), { "directions" });
}

TEST(framePlan, directionsThatAreTheNormalsAreNotHeldTwice)
{
	PlanInput input = fullInput();
	input.scene.directions_are_normals = true;
	const FramePlan plan = planOf(input);
	expectLeftOut(plan, { "directions" });
	expectKept(plan, { "normals" });
}

TEST(framePlan, withoutTessellationThereIsNoTableAndNoPart)
{
	for (const bool rate_is_off : { true, false })
	{
		PlanInput input = fullInput();
		if (rate_is_off)
			input.options.rate = 0;
		else
			input.view.factors_above_one = false;
		const FramePlan plan = planOf(input);
		expectDropped(plan, { "cluster_classify", "triangle_split", "batch_parts", "draw_batches" });
		expectLeftOut(plan, { "patterns", "table_vertices", "table_triangles", "part_triangles", "split_triangles", "batches" });
		EXPECT_TRUE(plan.has("draw_clusters"));
		EXPECT_EQ(featureOn(plan, "HAS_TESSELLATION"), !rate_is_off) << "what depends on the view must not recompile";
	}
}

TEST(framePlan, splittingIsPlannedOnlyWhereItCanOccur)
{
	PlanInput input = fullInput();
	input.view.split_levels = 0;
	const FramePlan none = planOf(input);
	expectDropped(none, { "triangle_split" });
	expectLeftOut(none, { "split_triangles" });
	input.view.split_levels = 5;
	const FramePlan five = planOf(input);
	EXPECT_EQ(std::count_if(five.steps.begin(), five.steps.end(), [](const PlanStep& step) { return step.pass->name == "triangle_split"; }), 5);
}

TEST(framePlan, withoutCullingNoBoundsAreHeld)
{
	PlanInput input = fullInput();
	input.options.cull = { false, false, false };
	const FramePlan plan = planOf(input);
	expectLeftOut(plan, { "cluster_bounds", "mesh_bounds" });
	EXPECT_FALSE(featureOn(plan, "HAS_CULLING"));
}

TEST(framePlan, framesThatDoNotLookForWhatIsHiddenDropThosePassesAndRecompileNothing)
{
	PlanInput input = fullInput();
	input.options.raster = Raster::Soft;
	input.device.buffer_atomics_64 = true;
	EXPECT_TRUE(planOf(input).has("depth_pyramid"));
	input.view.looks_for_hidden = false;
	const FramePlan resting = planOf(input);
	expectDropped(resting, { "depth_pyramid", "retest_parts", "raster_revealed" });
	EXPECT_TRUE(resting.has("raster_micro"));
	EXPECT_TRUE(featureOn(resting, "HAS_OCCLUSION"));
	EXPECT_NE(resting.reason("depth_pyramid").find("hid too little"), std::string::npos);
	input.options.cull.occlusion = false;
	const FramePlan without = planOf(input);
	expectDropped(without, { "depth_pyramid", "retest_parts", "raster_revealed" });
	expectLeftOut(without, { "depth_pyramid", "frame_history", "window_seen", "triangle_reaches" });
	EXPECT_FALSE(featureOn(without, "HAS_OCCLUSION"));
}

TEST(framePlan, withoutTexturesAndColorsTheirCodeIsCompiledOut)
{
	PlanInput input = fullInput();
	input.scene.has_color_textures = input.scene.has_vertex_colors = false;
	const FramePlan plan = planOf(input);
	expectLeftOut(plan, { "color_textures", "color_uvs", "colors" });
	EXPECT_FALSE(featureOn(plan, "HAS_COLOR_TEXTURES"));
	EXPECT_FALSE(featureOn(plan, "HAS_VERTEX_COLORS"));
}

TEST(framePlan, withoutMeshShadersTrianglesAreDrawnIndexed)
{
	PlanInput input = fullInput();
	input.device.mesh_shader = false;
	input.options.raster = Raster::Auto;
	const FramePlan plan = planOf(input);
	EXPECT_TRUE(plan.has("draw_indexed"));
	expectDropped(plan, { "draw_clusters", "draw_batches" });
	EXPECT_NE(plan.reason("draw_batches").find("VK_EXT_mesh_shader"), std::string::npos);
	expectKept(plan, { "micro_vertices", "expanded_triangles", "indexed_draw" });
	EXPECT_TRUE(featureOn(plan, "EXPANDS_TRIANGLES"));
}

TEST(framePlan, withMeshShadersNoTriangleIsExpanded)
{
	const FramePlan plan = planOf(fullInput());
	expectDropped(plan, { "draw_indexed" });
	expectLeftOut(plan, { "expanded_triangles", "indexed_draw" });
	expectKept(plan, { "micro_vertices" });
}

TEST(framePlan, indexedDrawingCanBeAskedForWhereMeshShadersAre)
{
	PlanInput input = fullInput();
	input.options.raster = Raster::Indexed;
	const FramePlan plan = planOf(input);
	EXPECT_TRUE(plan.has("draw_indexed"));
	expectDropped(plan, { "draw_clusters", "draw_batches" });
}

TEST(framePlan, theRasterPathIsChosenByDeviceAndRateAndSaysWhy)
{
	PlanInput input = fullInput();
	const auto choice = [&](bool atomics, bool mesh, bool primitive_id, float rate) {
		input.options.raster = Raster::Auto;
		input.options.rate = rate;
		input.device = { mesh, atomics, primitive_id, false };
		const RasterChoice chosen = rasterChoice(input);
		EXPECT_FALSE(chosen.reason.empty());
		EXPECT_EQ(chosenRaster(input), chosen.raster);
		return chosen;
	};
	EXPECT_EQ(choice(true, true, true, 4).raster, Raster::Soft);
	EXPECT_EQ(choice(true, true, true, 100).raster, Raster::Mesh);
	EXPECT_EQ(choice(true, false, true, 100).raster, Raster::Indexed);
	EXPECT_EQ(choice(true, false, false, 100).raster, Raster::Soft);
	EXPECT_EQ(choice(true, true, true, 0).raster, Raster::Mesh);
	EXPECT_EQ(choice(false, true, true, 4).raster, Raster::Mesh);
	EXPECT_EQ(choice(false, false, true, 4).raster, Raster::Indexed);
	EXPECT_NE(choice(true, true, true, 0).reason, choice(true, true, true, 100).reason);
	input.options.raster = Raster::Indexed;
	EXPECT_EQ(rasterChoice(input).reason, "asked for");
}

TEST(framePlan, whatCannotBeDrawnIsRefusedWithTheReasons)
{
	PlanInput input = fullInput();
	input.options.raster = Raster::Indexed;
	input.device.fragment_primitive_id = false;
	const Result<FramePlan> plan = planFrame(framePasses(), resourceDescs(), kWanted, input);
	ASSERT_FALSE(plan);
	EXPECT_EQ(plan.error().code, ExitCode::DeviceCannot);
	EXPECT_NE(plan.error().message.find("draw_clusters: "), std::string::npos) << plan.error().message;
	EXPECT_NE(plan.error().message.find("draw_indexed: "), std::string::npos) << plan.error().message;
}

}  // namespace tessera::test
