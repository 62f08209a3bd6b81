// trace_visibility and trace_clusters: primary rays, through one structure of all micro-triangles or through clusters.
#include "raytracing/trace_visibility.h"

#include "frame/ray_clusters.h"
#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr std::array<Use, 13> kTracedUses = { {
	{ "view", Access::RayRead },
	{ "ray_scene", Access::RayRead },
	{ "ray_geometry", Access::RayRead },
	{ "mesh_structures", Access::RayRead, &kRtShares },
	{ "instances", Access::RayRead, &kRtShares },
	{ "meshes", Access::RayRead, &kRtShares },
	{ "shared_instances", Access::RayRead, &kRtShares },
	{ "shared_clusters", Access::RayRead, &kRtShares },
	{ "clusters", Access::RayRead, &kRtFindsClusters },
	{ "visible_clusters", Access::RayRead, &kRtMixedSides },
	{ "part_triangles", Access::RayRead, &kRtMixedSidesOfParts },
	{ "material_flags", Access::RayRead, &kRtMixedSides },
	{ "visibility_buffer", Access::RayWrite },
} };
static constexpr auto kTriangleUses = joinUses(kTracedUses, std::array<Use, 1>{ { { "expanded_triangles", Access::RayRead } } });
static constexpr auto kClusterUses =
	joinUses(kTracedUses, std::array<Use, 2>{ { { "ray_clusters", Access::RayRead }, { "ray_payloads", Access::RayRead, &kTransients } } });

static TraceVisibilityArgs argsFor(const PassContext& pass)
{
	TraceVisibilityArgs args = {};
	args.inputs.clusters = pass.address("clusters");
	args.inputs.visible_clusters = pass.address("visible_clusters");
	args.inputs.part_triangles = pass.address("part_triangles");
	args.inputs.material_flags = pass.address("material_flags");
	args.inputs.instances = pass.address("instances");
	args.meshes = pass.address("meshes");
	args.shared_instances = pass.address("shared_instances");
	args.shared_clusters = pass.address("shared_clusters");
	args.visibility = pass.address("visibility_buffer");
	return args;
}

static void recordTriangles(PassContext& pass)
{
	TraceVisibilityArgs args = argsFor(pass);
	args.payloads = pass.address("expanded_triangles");
	args.first_payload = 3 * pass.capacity("expanded_triangles");
	pass.traceRays(args);
}

static void recordClusters(PassContext& pass)
{
	TraceVisibilityArgs args = argsFor(pass);
	args.payloads = pass.clusters().payloads();
	pass.traceRays(args);
}

static constexpr const Condition* kTrianglesNeeded[] = { &kRtTriangles };
static constexpr const Condition* kClustersNeeded[] = { &kRtClusters };
static constexpr std::string_view kTriangleShaders[] = { "raytracing/trace_visibility.rgen", "raytracing/trace_visibility.rmiss",
														 "raytracing/trace_visibility.rchit", "raytracing/trace_visibility.rahit" };
static constexpr std::string_view kClusterShaders[] = { "raytracing/trace_visibility.rgen", "raytracing/trace_visibility.rmiss",
														"raytracing/trace_clusters.rchit", "raytracing/trace_clusters.rahit" };

const PassDesc kTraceVisibility = { "trace_visibility", kTriangleUses, kTrianglesNeeded, kTriangleShaders, nullptr, recordTriangles };
const PassDesc kTraceClusters = { "trace_clusters", kClusterUses, kClustersNeeded, kClusterShaders, nullptr, recordClusters };

}  // namespace tessera
