#include "culling/cluster_cull.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "frame_history", Access::ComputeRead, &kMayHide },
	{ "depth_pyramid", Access::ComputeRead, &kMayHide },
	{ "cluster_groups", Access::ComputeRead },
	{ "view", Access::ComputeRead },
	{ "instances", Access::ComputeRead },
	{ "clusters", Access::ComputeRead },
	{ "cluster_bounds", Access::ComputeRead, &kCulls },
	{ "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },
	{ "visible_clusters", Access::ComputeWrite },
	{ "full_clusters", Access::ComputeWrite, &kDoesNotTessellate },
	{ "meshes", Access::ComputeRead, &kRtShares },
	{ "shared_instances", Access::ComputeRead, &kSharesStructures },
	{ "shared_clusters", Access::ComputeWrite, &kRtShares },
};

static void record(PassContext& pass)
{
	ClusterCullArgs args = {};
	args.instances = pass.address("instances");
	args.clusters = pass.address("clusters");
	args.cluster_bounds = pass.address("cluster_bounds");
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.cluster_groups = pass.address("cluster_groups");
	args.visible_clusters = pass.address("visible_clusters");
	args.full_clusters = pass.address("full_clusters");
	args.meshes = pass.address("meshes");
	args.shared_instances = pass.address("shared_instances");
	args.shared_clusters = pass.address("shared_clusters");
	args.cull_frustum = culling(pass.input()).frustum ? 1 : 0;
	args.cull_backface = culling(pass.input()).backface ? 1 : 0;
	args.emit_full = kDoesNotTessellate.holds(pass.input()) ? 1 : 0;
	pass.dispatchLoop(args, pass.capacity("cluster_groups"));
}

static constexpr std::string_view kShaders[] = { "culling/cluster_cull.comp" };

const PassDesc kClusterCull = { "cluster_cull", kUses, {}, kShaders, nullptr, record };

}  // namespace tessera
