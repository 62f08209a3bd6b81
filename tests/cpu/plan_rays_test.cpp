// What rays add to a plan, and what they leave out.
#include "plan_checks.h"

#include "plan/conditions.h"

#include <gtest/gtest.h>

namespace tessera::test
{

namespace
{

constexpr std::string_view kClusterPasses[] = { "clear_clusters",       "list_clusters",    "list_structures", "insert_clusters",
												"instantiate_clusters", "build_transients", "build_structures" };

}  // namespace

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

TEST(framePlan, whatIsHiddenFallsOffOnlyWhereItCanBeMeasured)
{
	PlanInput input = fullInput();
	input.device.rays = input.device.buffer_atomics_64 = true;
	input.options.shadows = true;
	for (const Raster raster : { Raster::Soft, Raster::Rt })
	{
		input.options.raster = raster;
		const FramePlan plan = planOf(input);
		EXPECT_TRUE(plan.has("measure_hidden") && plan.has("depth_pyramid")) << rasterName(raster);
		EXPECT_TRUE(featureOn(plan, "HAS_HIDDEN_FALLOFF") && plan.keeps("hidden_instances") && plan.keeps("mesh_bounds")) << rasterName(raster);
		EXPECT_FALSE(plan.has("retest_parts") || featureOn(plan, "HAS_OCCLUSION")) << "nothing is culled";
	}
	const auto expectNothing = [](const PlanInput& other, const char* what) {
		const FramePlan plan = planOf(other);
		expectDropped(plan, { "measure_hidden", "depth_pyramid" });
		expectLeftOut(plan, { "hidden_instances", "hidden_instances_next", "depth_pyramid", "frame_history" });
		EXPECT_FALSE(featureOn(plan, "HAS_HIDDEN_FALLOFF")) << what;
	};
	PlanInput unlit = input, off = input, single = input, attached = input, as_stored = input, level = input;
	unlit.options.shadows = false;
	expectNothing(unlit, "no light is traced");
	off.options.ray_hidden = false;
	expectNothing(off, "it is off");
	level.options.ray_falloff = 0;
	expectNothing(level, "nothing falls off");
	single.sizes.instances = 1;
	expectNothing(single, "nothing can hide the only instance");
	EXPECT_NE(planOf(single).reason("measure_hidden").find("segments of what is hidden do not grow"), std::string::npos);
	attached.options.raster = Raster::Mesh;
	expectNothing(attached, "depth lies in an attachment");
	as_stored.options.rate = 0;
	expectNothing(as_stored, "nothing is tessellated");
	// Seen from elsewhere it stays as it is: tessellated as for the other camera, with nothing to measure.
	PlanInput elsewhere = input;
	elsewhere.view.is_seen_elsewhere = true;
	EXPECT_FALSE(planOf(elsewhere).has("measure_hidden"));
	EXPECT_TRUE(featureOn(planOf(elsewhere), "HAS_HIDDEN_FALLOFF") && planOf(elsewhere).keeps("hidden_instances"));
}

// Only where an instance may share from here; made in the frame that first needs it.
TEST(framePlan, structuresAreSharedWhereAnInstanceMayAndMadeOnce)
{
	constexpr std::string_view kShared[] = { "shared_instances", "shared_clusters", "mesh_addresses", "mesh_inputs", "mesh_structures" };
	PlanInput input = fullInput();
	input.device.rays = true;
	input.device.most_structure_instances = 1000;
	input.options.raster = Raster::Rt;
	const auto expectNone = [&](const PlanInput& none, const char* what) {
		const FramePlan plan = planOf(none);
		expectDropped(plan, { "expand_meshes", "build_meshes" });
		EXPECT_FALSE(featureOn(plan, "SHARES_STRUCTURES")) << what;
		for (std::string_view resource : kShared)
			EXPECT_FALSE(plan.keeps(resource)) << what << ": " << resource;
	};
	expectNone(input, "no instance may");
	input.view.shares_structures = input.view.makes_structures = true;
	const FramePlan first = planOf(input);
	EXPECT_TRUE(first.has("expand_meshes") && first.has("build_meshes") && featureOn(first, "SHARES_STRUCTURES"));
	for (std::string_view resource : kShared)
		EXPECT_TRUE(first.keeps(resource)) << resource;
	input.view.makes_structures = false;
	const FramePlan second = planOf(input);
	expectDropped(second, { "expand_meshes", "build_meshes" });
	EXPECT_TRUE(featureOn(second, "SHARES_STRUCTURES"));
	EXPECT_FALSE(second.keeps("mesh_inputs"));
	EXPECT_FALSE(featureOn(second, "KEEPS_PLACES"));

	PlanInput off = input, rounds = input, elsewhere = input, indexed = input, clusters = input, many = input, shadows = input;
	off.options.ray_sharing = false;
	expectNone(off, "--ray-sharing off");
	rounds.view.rounds = 2;
	expectNone(rounds, "rounds");
	elsewhere.view.is_seen_elsewhere = true;
	expectNone(elsewhere, "seen from another camera");
	indexed.options.raster = Raster::Indexed;
	indexed.options.shadows = true;
	expectNone(indexed, "drawn by indices");
	clusters.device.clusters = true;
	expectNone(clusters, "through clusters");
	many.sizes.instances = 1000;
	expectNone(many, "more instances than a scene of rays holds, with the frame's own");
	shadows.options.raster = Raster::Soft;
	shadows.options.shadows = shadows.device.buffer_atomics_64 = true;
	const FramePlan light = planOf(shadows);
	EXPECT_TRUE(light.keeps("shared_instances") && light.keeps("mesh_structures"));
	EXPECT_FALSE(light.keeps("shared_clusters")) << "no primary ray asks what it met";
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

TEST(framePlan, raysGoThroughClustersWhereTheDeviceBuildsThem)
{
	PlanInput input = fullInput();
	input.device.rays = input.device.clusters = true;
	input.options.raster = Raster::Rt;
	FramePlan plan = planOf(input);
	for (std::string_view pass : kClusterPasses)
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
		for (std::string_view pass : kClusterPasses)
			EXPECT_FALSE(plan.has(pass)) << pass;
		EXPECT_NE(plan.reason("list_clusters").find("device lacks VK_NV_cluster_acceleration_structure"), std::string::npos);
		EXPECT_TRUE(plan.has("build_geometry") && plan.has("trace_visibility"));
		EXPECT_FALSE(featureOn(plan, "BUILDS_CLUSTERS"));
		EXPECT_EQ(rayPathChoice(input).reason, asked_for ? "asked for" : "the device lacks VK_NV_cluster_acceleration_structure");
	}
	input.options = {};
	input.device.clusters = true;
	const FramePlan without = planOf(input);
	for (std::string_view pass : kClusterPasses)
		EXPECT_FALSE(without.has(pass)) << pass << ": no rays are traced";
}

TEST(framePlan, lightKeepsWhatCullingWouldRemove)
{
	PlanInput input = fullInput();
	input.device.rays = input.device.buffer_atomics_64 = true;
	input.options.raster = Raster::Soft;
	input.options.shadows = true;
	input.options.ray_hidden = false;
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

}  // namespace tessera::test
