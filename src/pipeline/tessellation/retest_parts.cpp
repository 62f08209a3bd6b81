// The second phase of occlusion culling: batches the parts, and marks the full clusters, that the frame before hid and this one
// does not. Shader: that of batch_parts.
#include "pipeline/passes.h"
#include "pipeline/tessellation/batch_parts_args.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "view", Access::ComputeRead },
	{ "surface", Access::ComputeRead },
	{ "frame_history", Access::ComputeRead },
	{ "depth_pyramid", Access::ComputeRead },
	{ "instances", Access::ComputeRead },
	{ "clusters", Access::ComputeRead },
	{ "cluster_bounds", Access::ComputeRead },
	{ "triangle_reaches", Access::ComputeRead, &kDisplacedPartsMayHide },
	{ "visible_clusters", Access::ComputeRead },
	{ "positions", Access::ComputeRead },
	{ "triangles", Access::ComputeRead },
	{ "full_clusters", Access::ComputeWrite },
	{ "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },
	{ "part_triangles", Access::ComputeRead, &kTessellates },
	{ "patterns", Access::ComputeRead, &kTessellates },
	{ "batches", Access::ComputeWrite, &kTessellates },
	{ "part_places", Access::ComputeWrite, &kTessellates },
	{ "window_seen", Access::ComputeRead, &kTessellates },
};

static void record(PassContext& pass)
{
	BatchPartsArgs args = batchPartsArgs(pass);
	args.full_clusters = pass.address("full_clusters");
	args.second_phase = 1;
	const uint64_t most = uint64_t(pass.capacity("full_clusters")) + (kTessellates.holds(pass.input()) ? pass.capacity("part_triangles") : 0);
	pass.dispatchLoop(args, most, BATCH_WINDOW);
}

static constexpr const Condition* kNeeded[] = { &kLooksForHidden };
static constexpr std::string_view kShaders[] = { "tessellation/batch_parts.comp" };

const PassDesc kRetestParts = { "retest_parts", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
