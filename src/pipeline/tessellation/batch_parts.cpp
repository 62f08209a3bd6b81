#include "tessellation/batch_parts.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "part_triangles", Access::ComputeRead }, { "patterns", Access::ComputeRead }, { "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },        { "batches", Access::ComputeWrite },
};

static void record(PassContext& pass)
{
	BatchPartsArgs args = {};
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.part_triangles = pass.address("part_triangles");
	args.patterns = pass.address("patterns");
	args.batches = pass.address("batches");
	pass.dispatchLoop(args, pass.capacity("part_triangles"), 128);
}

static constexpr const Condition* kNeeded[] = { &kTessellates };
static constexpr std::string_view kShaders[] = { "tessellation/batch_parts.comp" };

const PassDesc kBatchParts = { "batch_parts", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
