#include "raster/keep_visibility.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "view", Access::ComputeRead },
	{ "visibility_depth", Access::ComputeRead, &kDraws },
	{ "visibility_payload", Access::ComputeRead, &kDraws },
	{ "visibility_buffer", Access::ComputeRead, &kBuffered },
	{ "kept_visibility", Access::ComputeWrite },
};

static void record(PassContext& pass)
{
	const KeepVisibilityArgs args = { pass.address("visibility_buffer"), pass.address("kept_visibility") };
	pass.dispatch(args, (pass.input().options.width_px + 7) / 8, (pass.input().options.height_px + 7) / 8);
}

static constexpr std::string_view kShaders[] = { "raster/keep_visibility.comp" };

const PassDesc kKeepVisibility = { "keep_visibility", kUses, {}, kShaders, nullptr, record };

}  // namespace tessera
