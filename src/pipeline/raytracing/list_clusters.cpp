// clear_clusters, list_clusters, list_structures and insert_clusters: what the driver is to build of clusters, all on the device.
#include "raytracing/list_clusters.h"

#include "frame/ray_clusters.h"
#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kClearUses[] = {
	{ "cluster_counts", Access::ComputeWrite },
	{ "instance_clusters", Access::ComputeWrite },
};

static void recordClear(PassContext& pass)
{
	pass.dispatchLoop(ClusterWorkArgs{ pass.clusters().work() }, pass.clusters().sceneInstances(), kThreadsOfAnyGroup);
}

static constexpr auto kListUses = joinUses(partUses(Access::ComputeRead), std::array<Use, 16>{ {
																			  { "surface", Access::ComputeRead },
																			  { "triangles", Access::ComputeRead },
																			  { "instances", Access::ComputeRead },
																			  { "clusters", Access::ComputeRead },
																			  { "visible_clusters", Access::ComputeRead },
																			  { "heads", Access::ComputeRead },
																			  { "counts", Access::ComputeRead },
																			  { "full_clusters", Access::ComputeRead },
																			  { "micro_vertices", Access::ComputeRead },
																			  { "window_vertices", Access::ComputeRead, &kClusterParts },
																			  { "cluster_templates", Access::ComputeRead },
																			  { "cluster_counts", Access::ComputeWrite },
																			  { "instance_clusters", Access::ComputeWrite },
																			  { "ray_inputs", Access::ComputeWrite },
																			  { "ray_payloads", Access::ComputeWrite, &kTransients },
																			  { "material_flags", Access::ComputeRead },
																		  } });

static void recordList(PassContext& pass)
{
	ListClustersArgs args = {};
	args.inputs = rasterInputs(pass);
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.full_clusters = pass.address("full_clusters");
	args.window_vertices = pass.address("window_vertices");
	args.vertices = pass.address("micro_vertices");
	args.work = pass.clusters().work();
	const uint64_t parts = kTessellates.holds(pass.input()) ? pass.capacity("part_triangles") : 0;
	pass.dispatchLoop(args, pass.capacity("full_clusters") + parts, BATCH_WINDOW);
}

static constexpr Use kStructuresUses[] = {
	{ "cluster_counts", Access::ComputeWrite },
	{ "instance_clusters", Access::ComputeWrite },
	{ "ray_references", Access::ComputeWrite },
};

static void recordStructures(PassContext& pass)
{
	pass.dispatchLoop(ClusterWorkArgs{ pass.clusters().work() }, pass.clusters().sceneInstances(), kThreadsOfAnyGroup);
}

static constexpr Use kInsertUses[] = {
	{ "cluster_counts", Access::ComputeRead },
	{ "instance_clusters", Access::ComputeRead },
	{ "ray_inputs", Access::ComputeRead },
	{ "ray_references", Access::ComputeWrite },
};

static void recordInsert(PassContext& pass)
{
	pass.dispatchLoop(ClusterWorkArgs{ pass.clusters().work() }, pass.clusters().mostClusters(), kThreadsOfAnyGroup);
}

static constexpr const Condition* kNeeded[] = { &kClusters };
static constexpr std::string_view kClearShaders[] = { "raytracing/clear_clusters.comp" };
static constexpr std::string_view kListShaders[] = { "raytracing/list_clusters.comp" };
static constexpr std::string_view kStructuresShaders[] = { "raytracing/list_structures.comp" };
static constexpr std::string_view kInsertShaders[] = { "raytracing/insert_clusters.comp" };

const PassDesc kClearClusters = { "clear_clusters", kClearUses, kNeeded, kClearShaders, nullptr, recordClear };
const PassDesc kListClusters = { "list_clusters", kListUses, kNeeded, kListShaders, nullptr, recordList };
const PassDesc kListStructures = { "list_structures", kStructuresUses, kNeeded, kStructuresShaders, nullptr, recordStructures };
const PassDesc kInsertClusters = { "insert_clusters", kInsertUses, kNeeded, kInsertShaders, nullptr, recordInsert };

}  // namespace tessera
