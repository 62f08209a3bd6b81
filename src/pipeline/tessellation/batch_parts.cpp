#include "pipeline/passes.h"
#include "pipeline/tessellation/batch_parts_args.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "view", Access::ComputeRead, &kPartsMayHide },
	{ "surface", Access::ComputeRead, &kPartsMayHide },
	{ "frame_history", Access::ComputeRead, &kPartsMayHide },
	{ "depth_pyramid", Access::ComputeRead, &kPartsMayHide },
	{ "instances", Access::ComputeRead, &kPartsMayHide },
	{ "clusters", Access::ComputeRead, &kPartsMayHide },
	{ "cluster_bounds", Access::ComputeRead, &kPartsMayHide },
	{ "triangle_reaches", Access::ComputeRead, &kDisplacedPartsMayHide },
	{ "visible_clusters", Access::ComputeRead, &kPartsMayHide },
	{ "positions", Access::ComputeRead, &kPartsMayHide },
	{ "triangles", Access::ComputeRead, &kPartsMayHide },
	{ "part_triangles", Access::ComputeRead },
	{ "patterns", Access::ComputeRead },
	{ "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },
	{ "batches", Access::ComputeWrite },
	{ "part_places", Access::ComputeWrite },
	{ "window_seen", Access::ComputeWrite, &kPartsMayHide },
	{ "window_vertices", Access::ComputeWrite, &kClusterParts },
};

static void record(PassContext& pass)
{
	pass.dispatchLoop(batchPartsArgs(pass), pass.capacity("part_triangles"), BATCH_WINDOW);
}

static constexpr const Condition* kNeeded[] = { &kTessellates };
static constexpr std::string_view kShaders[] = { "tessellation/batch_parts.comp" };

const PassDesc kBatchParts = { "batch_parts", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
