#include "tessellation/rate_fit.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },
	{ "indexed_draw", Access::ComputeWrite, &kIndexed },
};

static void record(PassContext& pass)
{
	RateFitArgs args = {};
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.indexed_draw = pass.address("indexed_draw");
	args.split_levels = splitLevels(pass.input());
	pass.dispatch(args, 1);
}

static constexpr std::string_view kShaders[] = { "tessellation/rate_fit.comp" };

const PassDesc kRateFit = { "rate_fit", kUses, {}, kShaders, nullptr, record };

}  // namespace tessera
