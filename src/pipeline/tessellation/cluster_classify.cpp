#include "tessellation/cluster_classify.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "frame_history", Access::ComputeRead, &kMayHide },
	{ "depth_pyramid", Access::ComputeRead, &kMayHide },
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
	{ "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },
	{ "full_clusters", Access::ComputeWrite },
	{ "split_triangles", Access::ComputeWrite, &kSplits },
	{ "part_triangles", Access::ComputeWrite },
	{ "shared_instances", Access::ComputeRead, &kSharesStructures },
};

static void record(PassContext& pass)
{
	ClusterClassifyArgs args = {};
	args.instances = pass.address("instances");
	args.clusters = pass.address("clusters");
	args.cluster_bounds = pass.address("cluster_bounds");
	args.positions = pass.address("positions");
	args.triangles = pass.address("triangles");
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.visible_clusters = pass.address("visible_clusters");
	args.full_clusters = pass.address("full_clusters");
	args.split_triangles = pass.address("split_triangles");
	args.part_triangles = pass.address("part_triangles");
	args.shared_instances = pass.address("shared_instances");
	args.rule = pass.factorRule();
	args.cull_frustum = culling(pass.input()).frustum ? 1 : 0;
	pass.dispatchLoop(args, pass.capacity("visible_clusters"));
}

static constexpr const Condition* kNeeded[] = { &kTessellates };
static constexpr std::string_view kShaders[] = { "tessellation/cluster_classify.comp" };

const PassDesc kClusterClassify = { "cluster_classify", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
