#include "tessellation/rate_search.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

#include <algorithm>

namespace tessera
{

// It needs somebody to have listed before: reads what it replaces.
static constexpr Use kUses[] = {
	{ "full_clusters", Access::ComputeRead },
	{ "visible_clusters", Access::ComputeRead },
	{ "surface", Access::ComputeRead },
	{ "instances", Access::ComputeRead },
	{ "clusters", Access::ComputeRead },
	{ "cluster_bounds", Access::ComputeRead, &kFrustumCulls },
	{ "positions", Access::ComputeRead },
	{ "triangles", Access::ComputeRead },
	{ "triangle_details", Access::ComputeRead, &kDetail },
	{ "edge_roughness", Access::ComputeRead, &kDisplacedEdges },
	{ "hidden_instances", Access::ComputeRead, &kHiddenFalloff },
	{ "patterns", Access::ComputeRead },
	{ "table_vertices", Access::ComputeRead },
	{ "table_triangles", Access::ComputeRead },
	{ "rate_steps", Access::ComputeWrite },
	{ "view", Access::ComputeWrite },
	{ "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },
	{ "full_clusters", Access::ComputeWrite },
	{ "split_triangles", Access::ComputeWrite, &kSplits },
	{ "part_triangles", Access::ComputeWrite },
	{ "shared_instances", Access::ComputeRead, &kSharesStructures },
};

constexpr uint64_t kMostWorkgroups = 1024;

// Count and choose, then list.
static uint32_t dispatches(const PlanInput&)
{
	return 2;
}

static void record(PassContext& pass)
{
	RateSearchArgs args = {};
	args.instances = pass.address("instances");
	args.clusters = pass.address("clusters");
	args.cluster_bounds = pass.address("cluster_bounds");
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.visible_clusters = pass.address("visible_clusters");
	args.full_clusters = pass.address("full_clusters");
	args.split_triangles = pass.address("split_triangles");
	args.part_triangles = pass.address("part_triangles");
	args.table = tableView(pass);
	args.steps = pass.address("rate_steps");
	args.view = pass.address("view");
	args.shared_instances = pass.address("shared_instances");
	args.step_count = pass.rateStepCount();
	args.modes = packSearch(pass.repeat(), pass.decidingLists(), splitLevels(pass.input()));
	// Few visible clusters can keep many workgroups busy: each at its own candidate. No more than that, since they mostly just end.
	pass.dispatchLoop(args, std::min<uint64_t>(kMostWorkgroups, uint64_t(pass.capacity("visible_clusters")) * args.step_count));
}

static constexpr const Condition* kNeeded[] = { &kTessellates };
static constexpr std::string_view kShaders[] = { "tessellation/rate_search.comp" };

const PassDesc kRateSearch = { "rate_search", kUses, kNeeded, kShaders, dispatches, record };

}  // namespace tessera
