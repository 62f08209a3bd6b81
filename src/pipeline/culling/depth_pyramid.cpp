#include "culling/depth_pyramid.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "view", Access::ComputeRead },
	{ "frame_history", Access::ComputeRead },
	{ "visibility_buffer", Access::ComputeRead },
	{ "depth_pyramid", Access::ComputeWrite },
};

// A workgroup's side.
constexpr uint32_t kTilePx = 16 * PYRAMID_TEXEL_PX;

static void record(PassContext& pass)
{
	DepthPyramidArgs args = {};
	args.visibility = pass.address("visibility_buffer");
	pass.dispatch(args, (pass.input().options.width_px + kTilePx - 1) / kTilePx, (pass.input().options.height_px + kTilePx - 1) / kTilePx);
}

static constexpr const Condition* kNeeded[] = { &kMakesPyramid };
static constexpr std::string_view kShaders[] = { "culling/depth_pyramid.comp" };

const PassDesc kDepthPyramid = { "depth_pyramid", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
