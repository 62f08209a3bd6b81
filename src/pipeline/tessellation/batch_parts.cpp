#include "tessellation/batch_parts.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"
#include "plan/conditions.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "part_triangles", Access::ComputeRead }, { "patterns", Access::ComputeRead }, { "heads", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite },        { "batches", Access::ComputeWrite }, { "part_offsets", Access::ComputeWrite },
};

static void record(PassContext& pass)
{
	BatchPartsArgs args = {};
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.part_triangles = pass.address("part_triangles");
	args.patterns = pass.address("patterns");
	args.batches = pass.address("batches");
	args.part_offsets = pass.address("part_offsets");
	args.most_vertices = usesSoft(pass.input()) ? RASTER_BATCH_VERTICES : BATCH_MAX_VERTICES;
	args.most_triangles = usesSoft(pass.input()) ? RASTER_BATCH_TRIANGLES : BATCH_MAX_TRIANGLES;
	pass.dispatchLoop(args, pass.capacity("part_triangles"), BATCH_WINDOW);
}

static constexpr const Condition* kNeeded[] = { &kTessellates };
static constexpr std::string_view kShaders[] = { "tessellation/batch_parts.comp" };

const PassDesc kBatchParts = { "batch_parts", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
