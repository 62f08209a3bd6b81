#include "culling/frame_begin.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },
};

static void record(PassContext& pass)
{
	pass.dispatch(FrameBeginArgs{ pass.address("heads"), pass.address("counts") }, 1);
}

static constexpr std::string_view kShaders[] = { "culling/frame_begin.comp" };

const PassDesc kFrameBegin = { "frame_begin", kUses, {}, kShaders, nullptr, record };

}  // namespace tessera
