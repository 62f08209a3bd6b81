#include "tessellation/triangle_split.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "visible_clusters", Access::ComputeRead },
	{ "view", Access::ComputeRead },
	{ "instances", Access::ComputeRead },
	{ "clusters", Access::ComputeRead },
	{ "cluster_bounds", Access::ComputeRead, &kCulls },
	{ "positions", Access::ComputeRead },
	{ "triangles", Access::ComputeRead },
	{ "surface", Access::ComputeRead, &kEdgeTables },
	{ "triangle_details", Access::ComputeRead, &kDetail },
	{ "edge_roughness", Access::ComputeRead, &kDisplacedEdges },
	{ "hidden_instances", Access::ComputeRead, &kHiddenFalloff },
	{ "patterns", Access::ComputeRead },
	{ "table_vertices", Access::ComputeRead },
	{ "table_triangles", Access::ComputeRead },
	{ "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },
	{ "split_triangles", Access::ComputeWrite },
	{ "part_triangles", Access::ComputeWrite },
};

// SPLITS_PER_GROUP of the shader.
constexpr uint32_t kSplitsPerGroup = 24;

static void record(PassContext& pass)
{
	TriangleSplitArgs args = {};
	args.instances = pass.address("instances");
	args.clusters = pass.address("clusters");
	args.cluster_bounds = pass.address("cluster_bounds");
	args.positions = pass.address("positions");
	args.triangles = pass.address("triangles");
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.visible_clusters = pass.address("visible_clusters");
	args.split_triangles = pass.address("split_triangles");
	args.part_triangles = pass.address("part_triangles");
	args.table = tableView(pass);
	args.rule = pass.factorRule();
	args.cull_frustum = culling(pass.input()).frustum ? 1 : 0;
	args.level = pass.repeat();
	args.last_level = pass.repeat() + 1 == splitLevels(pass.input()) ? 1 : 0;
	pass.dispatchLoop(args, pass.capacity("split_triangles"), kSplitsPerGroup);
}

static constexpr const Condition* kNeeded[] = { &kSplits };
static constexpr std::string_view kShaders[] = { "tessellation/triangle_split.comp" };

const PassDesc kTriangleSplit = { "triangle_split", kUses, kNeeded, kShaders, splitLevels, record };

}  // namespace tessera
