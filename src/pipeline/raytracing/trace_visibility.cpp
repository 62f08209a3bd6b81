#include "raytracing/trace_visibility.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "view", Access::RayRead },
	{ "ray_scene", Access::RayRead },
	{ "ray_geometry", Access::RayRead },
	{ "expanded_triangles", Access::RayRead },
	{ "clusters", Access::RayRead, &kRtMixedSides },
	{ "visible_clusters", Access::RayRead, &kRtMixedSides },
	{ "part_triangles", Access::RayRead, &kRtMixedSidesOfParts },
	{ "material_flags", Access::RayRead, &kRtMixedSides },
	{ "visibility_buffer", Access::RayWrite },
};

static void record(PassContext& pass)
{
	TraceVisibilityArgs args = {};
	args.inputs.clusters = pass.address("clusters");
	args.inputs.visible_clusters = pass.address("visible_clusters");
	args.inputs.part_triangles = pass.address("part_triangles");
	args.inputs.material_flags = pass.address("material_flags");
	args.expanded_triangles = pass.address("expanded_triangles");
	args.first_payload = 3 * pass.capacity("expanded_triangles");
	args.visibility = pass.address("visibility_buffer");
	pass.traceRays(args);
}

static constexpr const Condition* kNeeded[] = { &kRt };
static constexpr std::string_view kShaders[] = { "raytracing/trace_visibility.rgen", "raytracing/trace_visibility.rmiss",
												 "raytracing/trace_visibility.rchit", "raytracing/trace_visibility.rahit" };

const PassDesc kTraceVisibility = { "trace_visibility", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
