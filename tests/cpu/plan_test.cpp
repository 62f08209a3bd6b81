// planFrame over the passes there are: what is kept, what is left out and why, and that every access is ordered.
#include "plan_inputs.h"

#include "frame/frame_resources.h"
#include "pipeline/passes.h"
#include "plan/conditions.h"
#include "plan/forced.h"
#include "plan/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace tessera::test
{

namespace
{

constexpr std::string_view kWanted[] = { "picture", "counts", "heads" };

FramePlan planOf(const PlanInput& input)
{
	Result<FramePlan> plan = planFrame(framePasses(), resourceDescs(), kWanted, input);
	EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
	return plan ? std::move(*plan) : FramePlan();
}

bool featureOn(const FramePlan& plan, std::string_view name)
{
	const auto found = std::find_if(plan.features.begin(), plan.features.end(), [&](const Feature& feature) { return feature.name == name; });
	EXPECT_NE(found, plan.features.end()) << name;
	return found != plan.features.end() && found->on;
}

bool featureOnIfAny(const FramePlan& plan, std::string_view name)
{
	return std::any_of(plan.features.begin(), plan.features.end(), [&](const Feature& feature) { return feature.name == name && feature.on; });
}

const PlannedResource& resourceOf(const FramePlan& plan, std::string_view name)
{
	static const PlannedResource kNone;
	const auto found = std::find_if(plan.resources.begin(), plan.resources.end(), [&](const PlannedResource& r) { return r.name == name; });
	EXPECT_NE(found, plan.resources.end()) << name;
	return found == plan.resources.end() ? kNone : *found;
}

void expectLeftOut(const FramePlan& plan, std::initializer_list<std::string_view> resources)
{
	for (std::string_view name : resources)
	{
		EXPECT_FALSE(plan.keeps(name)) << name;
		EXPECT_FALSE(resourceOf(plan, name).reason.empty()) << name;
	}
}

void expectKept(const FramePlan& plan, std::initializer_list<std::string_view> resources)
{
	for (std::string_view name : resources)
		EXPECT_TRUE(plan.keeps(name)) << name << ": " << resourceOf(plan, name).reason;
}

void expectDropped(const FramePlan& plan, std::initializer_list<std::string_view> passes)
{
	for (std::string_view name : passes)
	{
		EXPECT_FALSE(plan.has(name)) << name;
		EXPECT_FALSE(plan.reason(name).empty()) << name;
	}
}

bool holds(const Use& use, const PlanInput& input)
{
	return !use.when || use.when->holds(input);
}

// A barrier after step `from` and no later than before step `to` that orders the first access before the second.
bool ordered(const FramePlan& plan, size_t from, Access first, size_t to, Access second)
{
	for (size_t i = from + 1; i <= to; ++i)
		if (plan.steps[i].wait_for.has(first) && plan.steps[i].then.has(second))
			return true;
	return false;
}

// The rule itself, spelled out: whenever two steps touch a resource and one of them writes, a barrier lies between, back to the
// last write. Appends count as reads too.
bool everyConflictIsOrdered(const FramePlan& plan, const PlanInput& input)
{
	for (size_t later = 0; later < plan.steps.size(); ++later)
		for (const Use& use : plan.steps[later].pass->uses)
		{
			bool met_writer = !holds(use, input);
			for (size_t earlier = later; earlier-- > 0 && !met_writer;)
				for (const Use& before : plan.steps[earlier].pass->uses)
				{
					if (before.resource != use.resource || !holds(before, input) || (!writes(before.access) && !writes(use.access)))
						continue;
					if (!ordered(plan, earlier, before.access, later, use.access))
						return false;
					met_writer |= writes(before.access);
				}
		}
	return true;
}

// Lists and images start a frame empty: who reads one must come after who writes it.
std::string readBeforeWritten(const FramePlan& plan, const PlanInput& input)
{
	std::vector<std::string_view> written;
	for (const PlanStep& step : plan.steps)
	{
		for (const Use& use : step.pass->uses)
		{
			const std::string_view kind = resourceOf(plan, use.resource).kind;
			const bool made_by_passes = kind == "list" || kind == "image";
			if (made_by_passes && holds(use, input) && !writes(use.access) &&
				std::find(written.begin(), written.end(), use.resource) == written.end())
				return fmt::format("{} reads {}", step.pass->name, use.resource);
		}
		for (const Use& use : step.pass->uses)
			if (holds(use, input) && writes(use.access))
				written.push_back(use.resource);
	}
	return "";
}

// Calls `visit` with every combination of what plans depend on.
void forEveryInput(const std::function<void(const PlanInput&)>& visit)
{
	for (uint32_t bits = 0; bits < 1u << 13; ++bits)
	{
		const auto bit = [&](uint32_t i) {
			return (bits >> i & 1u) != 0;
		};
		PlanInput input = fullInput();
		input.device.mesh_shader = bit(0);
		input.device.fragment_primitive_id = bit(1);
		input.options.raster = bit(2) ? Raster::Indexed : bit(3) ? Raster::Mesh : Raster::Auto;
		input.scene.has_displacement = bit(4);
		input.scene.seam_edges = input.scene.seam_corners = bit(5) ? 3 : 0;
		input.options.rate = bit(6) ? 4.0f : 0.0f;
		input.view.factors_above_one = bit(7);
		input.view.split_levels = bit(8) ? 2 : 0;
		input.options.cull = { bit(9), bit(9), bit(9) };
		input.scene.has_color_textures = bit(10);
		input.options.smooth_normals = bit(11);
		input.scene.directions_are_normals = bit(12);
		input.scene.has_pn = bit(12) != bit(4);
		input.scene.has_vertex_colors = bit(3);
		input.options.view = bit(2) ? ViewMode::Shaded : ViewMode::Depth;
		visit(input);
	}
}

}  // namespace

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

// Everything that is left out is either kept when it is forced, and said to be, or cannot be and why is said.
TEST(framePlan, whateverIsLeftOutIsForcedOrSaidWhyNot)
{
	size_t forced_count = 0, refused_count = 0, inputs = 0;
	forEveryInput([&](const PlanInput& input) {
		// A spread of them: this plans many times for each.
		if (++inputs % 97 != 0 || !planFrame(framePasses(), resourceDescs(), kWanted, input))
			return;
		for (const std::string_view name : forceNames(framePasses(), resourceDescs()))
		{
			const std::string names[] = { std::string(name) };
			const auto forced = forcedBy(names, framePasses(), resourceDescs(), kWanted, input);
			if (!forced)
			{
				EXPECT_EQ(forced.error().code, ExitCode::Usage);
				EXPECT_NE(forced.error().message.find("cannot be forced: "), std::string::npos) << forced.error().message;
				++refused_count;
				continue;
			}
			PlanInput with = input;
			with.forced = *forced;
			const FramePlan plan = planOf(with), before = planOf(input);
			const auto feature = std::find_if(plan.features.begin(), plan.features.end(), [&](const Feature& f) { return f.name == name; });
			const bool is_there = plan.has(name) || plan.keeps(name) || (feature != plan.features.end() && feature->on);
			const bool was_there = before.has(name) || before.keeps(name) || featureOnIfAny(before, name);
			EXPECT_TRUE(is_there) << name << ", " << fmt::format("{}", fmt::join(forced->outputs, " ")) << ", conditions "
								  << forced->conditions.size();
			EXPECT_TRUE(plan.everyReadHasAnEarlierWriteAndABarrier(with)) << name;
			EXPECT_EQ(readBeforeWritten(plan, with), "") << name;
			if (is_there && !was_there)
			{
				const bool marked = (feature != plan.features.end() && feature->forced) || (plan.keeps(name) && resourceOf(plan, name).forced) ||
									std::any_of(plan.forced.begin(), plan.forced.end(), [&](const DroppedPass& pass) { return pass.name == name; });
				EXPECT_TRUE(marked) << name;
				++forced_count;
			}
		}
	});
	EXPECT_GT(forced_count, 500u);
	EXPECT_GT(refused_count, 500u);
}

TEST(framePlan, unknownNamesToForceAreRefusedWithThoseThereAre)
{
	const std::string names[] = { "raster_macro" };
	const auto forced = forcedBy(names, framePasses(), resourceDescs(), kWanted, fullInput());
	ASSERT_FALSE(forced);
	EXPECT_EQ(forced.error().code, ExitCode::Usage);
	EXPECT_NE(forced.error().message.find("raster_micro"), std::string::npos);
	EXPECT_EQ(forced.error().message.find('\n'), std::string::npos);
}

TEST(framePlan, oneForcedThingMayNeedAnotherInAnyOrder)
{
	PlanInput input = fullInput();
	input.scene.has_displacement = false;
	const std::string seams_alone[] = { "HAS_SEAMS" }, both[] = { "HAS_SEAMS", "HAS_DISPLACEMENT" };
	EXPECT_FALSE(forcedBy(seams_alone, framePasses(), resourceDescs(), kWanted, input));
	const auto forced = forcedBy(both, framePasses(), resourceDescs(), kWanted, input);
	ASSERT_TRUE(forced);
	input.forced = *forced;
	EXPECT_TRUE(featureOn(planOf(input), "HAS_SEAMS"));
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

TEST(framePlan, nothingOfRaysIsPlannedUntilAskedFor)
{
	PlanInput input = fullInput();
	input.device.rays = true;
	const FramePlan plan = planOf(input);
	expectDropped(plan, { "build_geometry", "place_instances", "build_scene", "trace_visibility", "trace_shadows", "trace_ambient" });
	expectLeftOut(plan,
				  { "ray_instances", "ray_geometry", "ray_scene", "ray_scratch", "sun_visibility", "ambient_visibility", "expanded_triangles" });
	for (const char* feature : { "HAS_RAYS", "HAS_SHADOWS", "HAS_AMBIENT_OCCLUSION", "HAS_RAY_FALLOFF" })
		EXPECT_FALSE(featureOn(plan, feature)) << feature;
}

TEST(framePlan, segmentsFallOffOutOfViewOnlyWhereRaysOfLightMeetThem)
{
	PlanInput input = fullInput();
	input.device.rays = true;
	input.options.raster = Raster::Rt;
	EXPECT_FALSE(featureOn(planOf(input), "HAS_RAY_FALLOFF")) << "what is out of view is culled";
	input.options.shadows = true;
	EXPECT_TRUE(featureOn(planOf(input), "HAS_RAY_FALLOFF"));
	PlanInput debug = input, off = input, coarse = input, ambient = input;
	debug.options.view = ViewMode::Factors;
	EXPECT_FALSE(featureOn(planOf(debug), "HAS_RAY_FALLOFF")) << "the view shows no light";
	off.options.ray_falloff = 0;
	EXPECT_FALSE(featureOn(planOf(off), "HAS_RAY_FALLOFF"));
	coarse.options.rate = 0;
	EXPECT_FALSE(featureOn(planOf(coarse), "HAS_RAY_FALLOFF"));
	ambient.options.shadows = false;
	ambient.options.ao_samples = 4;
	EXPECT_TRUE(featureOn(planOf(ambient), "HAS_RAY_FALLOFF"));
}

TEST(framePlan, raysFindVisibilityInPlaceOfRasterisers)
{
	PlanInput input = fullInput();
	input.device.rays = true;
	input.options.raster = Raster::Rt;
	const FramePlan plan = planOf(input);
	for (const char* pass : { "evaluate_vertices", "build_geometry", "build_scene", "trace_visibility" })
		EXPECT_TRUE(plan.has(pass)) << pass;
	expectDropped(plan, { "raster_micro", "draw_clusters", "draw_batches", "draw_indexed", "trace_shadows", "trace_ambient", "depth_pyramid" });
	expectLeftOut(plan, { "visibility_depth", "visibility_payload", "indexed_draw" });
	EXPECT_TRUE(featureOn(plan, "HAS_CULLING")) << "what is out of view is met by no primary ray";
	EXPECT_FALSE(featureOn(plan, "HAS_OCCLUSION"));
}

const std::vector<std::string> kClusterPasses = { "clear_clusters",       "list_clusters",    "list_structures", "insert_clusters",
												  "instantiate_clusters", "build_transients", "build_structures" };

TEST(framePlan, raysGoThroughClustersWhereTheDeviceBuildsThem)
{
	PlanInput input = fullInput();
	input.device.rays = input.device.clusters = true;
	input.options.raster = Raster::Rt;
	FramePlan plan = planOf(input);
	for (const std::string& pass : kClusterPasses)
		EXPECT_TRUE(plan.has(pass)) << pass;
	EXPECT_TRUE(plan.has("trace_clusters") && plan.has("place_instances") && plan.has("build_scene"));
	expectDropped(plan, { "build_geometry", "trace_visibility" });
	expectLeftOut(plan, { "expanded_triangles" });
	EXPECT_TRUE(featureOn(plan, "BUILDS_CLUSTERS") && featureOn(plan, "HAS_TRANSIENT_UNITS") && featureOn(plan, "HAS_TRANSIENT_GROUPS"));
	EXPECT_FALSE(featureOn(plan, "EXPANDS_TRIANGLES"));
	input.options.transient_units = input.options.transient_groups = false;
	plan = planOf(input);
	expectDropped(plan, { "build_transients" });
	expectLeftOut(plan, { "ray_payloads" });
	input.options.rate = 0;
	plan = planOf(input);
	EXPECT_TRUE(plan.has("instantiate_clusters")) << "full clusters are made from templates, too";
	expectLeftOut(plan, { "window_vertices" });
	EXPECT_FALSE(featureOn(plan, "KEEPS_PLACES")) << "nothing is refitted";
}

TEST(framePlan, clustersAreLeftOutWithTheReason)
{
	PlanInput input = fullInput();
	input.device.rays = true;
	input.options.raster = Raster::Rt;
	for (const bool asked_for : { false, true })
	{
		input.device.clusters = asked_for;
		input.options.ray_path = asked_for ? RayPath::Triangles : RayPath::Auto;
		const FramePlan plan = planOf(input);
		for (const std::string& pass : kClusterPasses)
			EXPECT_FALSE(plan.has(pass)) << pass;
		EXPECT_NE(plan.reason("list_clusters").find("device lacks VK_NV_cluster_acceleration_structure"), std::string::npos);
		EXPECT_TRUE(plan.has("build_geometry") && plan.has("trace_visibility"));
		EXPECT_FALSE(featureOn(plan, "BUILDS_CLUSTERS"));
		EXPECT_EQ(rayPathChoice(input).reason, asked_for ? "asked for" : "the device lacks VK_NV_cluster_acceleration_structure");
	}
	input.options = {};
	input.device.clusters = true;
	const FramePlan without = planOf(input);
	for (const std::string& pass : kClusterPasses)
		EXPECT_FALSE(without.has(pass)) << pass << ": no rays are traced";
}

TEST(framePlan, lightKeepsWhatCullingWouldRemove)
{
	PlanInput input = fullInput();
	input.device.rays = input.device.buffer_atomics_64 = true;
	input.options.raster = Raster::Soft;
	input.options.shadows = true;
	const FramePlan plan = planOf(input);
	EXPECT_TRUE(plan.has("trace_shadows"));
	expectDropped(plan, { "trace_ambient", "trace_visibility", "depth_pyramid", "raster_revealed" });
	expectLeftOut(plan, { "ambient_visibility", "cluster_bounds", "mesh_bounds" });
	EXPECT_FALSE(featureOn(plan, "HAS_CULLING"));
	// Views that show no light trace none, and cull again.
	input.options.view = ViewMode::Factors;
	const FramePlan view = planOf(input);
	expectDropped(view, { "trace_shadows", "build_geometry" });
	EXPECT_TRUE(featureOn(view, "HAS_CULLING"));
}

TEST(framePlan, raysOfADeviceThatHasNoneAreRefusedWithTheReason)
{
	PlanInput input = fullInput();
	input.options.raster = Raster::Rt;
	const Result<FramePlan> plan = planFrame(framePasses(), resourceDescs(), kWanted, input);
	ASSERT_FALSE(plan);
	EXPECT_EQ(plan.error().code, ExitCode::DeviceCannot);
	EXPECT_NE(plan.error().message.find("lacks acceleration structures"), std::string::npos) << plan.error().message;
}

TEST(framePlan, everyAccessOfRaysIsOrderedToo)
{
	for (uint32_t i = 0; i < 1024; ++i)
	{
		const auto bit = [&](uint32_t b) {
			return (i >> b & 1u) != 0;
		};
		PlanInput input = fullInput();
		input.device.rays = input.device.buffer_atomics_64 = true;
		constexpr Raster kRasters[] = { Raster::Soft, Raster::Mesh, Raster::Indexed, Raster::Rt };
		input.options.raster = kRasters[i % 4];
		input.options.shadows = bit(2);
		input.options.ao_samples = bit(3) ? 4 : 0;
		input.options.rate = bit(4) ? 4.0f : 0.0f;
		input.scene.has_double_sided = bit(5);
		input.view.split_levels = bit(6) ? 3 : 0;
		input.options.view = bit(7) ? ViewMode::Shaded : ViewMode::Clusters;
		input.device.clusters = bit(8);
		input.options.transient_units = input.options.transient_groups = bit(9);
		const FramePlan plan = planOf(input);
		ASSERT_TRUE(plan.everyReadHasAnEarlierWriteAndABarrier(input)) << i;
		ASSERT_TRUE(everyConflictIsOrdered(plan, input)) << i;
		ASSERT_EQ(readBeforeWritten(plan, input), "") << i;
		for (const PassDesc* pass : framePasses())
			ASSERT_EQ(plan.has(pass->name), plan.reason(pass->name).empty()) << pass->name;
		for (const PlannedResource& resource : plan.resources)
			ASSERT_EQ(resource.kept, resource.reason.empty()) << resource.name;
	}
}

TEST(framePlan, onlyTheFirstDrawClearsDepth)
{
	const FramePlan plan = planOf(fullInput());
	EXPECT_EQ(std::count_if(plan.steps.begin(), plan.steps.end(), [](const PlanStep& step) { return step.clears_depth; }), 1);
	const auto first = std::find_if(plan.steps.begin(), plan.steps.end(), [](const PlanStep& step) { return step.clears_depth; });
	ASSERT_NE(first, plan.steps.end());
	EXPECT_EQ(first->pass->name, "draw_clusters");
}

TEST(framePlan, everyAccessIsOrderedWhateverIsAsked)
{
	uint32_t planned = 0;
	forEveryInput([&](const PlanInput& input) {
		const Result<FramePlan> plan = planFrame(framePasses(), resourceDescs(), kWanted, input);
		const bool can_mesh = input.device.mesh_shader && input.options.raster != Raster::Indexed;
		const bool can_index = input.device.fragment_primitive_id &&
							   (input.options.raster == Raster::Indexed || (input.options.raster == Raster::Auto && !input.device.mesh_shader));
		if (!plan || (!can_mesh && !can_index))
		{
			EXPECT_FALSE(can_mesh || can_index) << plan.error().message;
			return;
		}
		++planned;
		ASSERT_TRUE(plan->everyReadHasAnEarlierWriteAndABarrier(input));
		ASSERT_TRUE(everyConflictIsOrdered(*plan, input));
		ASSERT_EQ(readBeforeWritten(*plan, input), "");
		for (const PassDesc* pass : framePasses())
			ASSERT_EQ(plan->has(pass->name), plan->reason(pass->name).empty()) << pass->name;
		for (const PlannedResource& resource : plan->resources)
			ASSERT_EQ(resource.kept, resource.reason.empty()) << resource.name;
	});
	EXPECT_GT(planned, 3000u);
}

TEST(framePlan, everyResourceThatPassesNameIsKnown)
{
	for (const PassDesc* pass : framePasses())
		for (const Use& use : pass->uses)
			EXPECT_TRUE(std::any_of(resourceDescs().begin(), resourceDescs().end(), [&](const ResourceDesc& r) { return r.name == use.resource; }))
				<< pass->name << ": " << use.resource;
}

TEST(framePlan, aBarrierTooFewIsNoticed)
{
	const PlanInput input = fullInput();
	const FramePlan plan = planOf(input);
	for (size_t i = 0; i < plan.steps.size(); ++i)
	{
		if (plan.steps[i].wait_for.empty())
			continue;
		FramePlan broken = plan;
		broken.steps[i].wait_for = broken.steps[i].then = {};
		EXPECT_FALSE(everyConflictIsOrdered(broken, input)) << plan.steps[i].pass->name << ": its barrier is not needed";
	}
	FramePlan broken = plan;
	for (PlanStep& step : broken.steps)
		step.wait_for = step.then = {};
	EXPECT_FALSE(broken.everyReadHasAnEarlierWriteAndABarrier(input));
}

TEST(framePlan, aReaderBeforeItsWriterIsNoticed)
{
	const PlanInput input = fullInput();
	FramePlan plan = planOf(input);
	std::reverse(plan.steps.begin(), plan.steps.end());
	EXPECT_FALSE(plan.everyReadHasAnEarlierWriteAndABarrier(input));
	EXPECT_NE(readBeforeWritten(plan, input), "");
}

TEST(framePlan, aMissingWriterIsNoticed)
{
	const PlanInput input = fullInput();
	for (const std::string_view missing : { "instance_classify", "cluster_cull", "cluster_classify", "batch_parts", "shade" })
	{
		std::vector<const PassDesc*> passes(framePasses().begin(), framePasses().end());
		std::erase_if(passes, [&](const PassDesc* pass) { return pass->name == missing; });
		const Result<FramePlan> plan = planFrame(passes, resourceDescs(), kWanted, input);
		ASSERT_FALSE(plan) << missing;
		EXPECT_EQ(plan.error().code, ExitCode::DeviceCannot) << missing;
	}
}

}  // namespace tessera::test
