#include "raster/raster_micro.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr auto kUses = joinUses(surfaceUses(Access::ComputeRead), partUses(Access::ComputeRead),
									   std::array<Use, 5>{ {
										   { "heads", Access::ComputeRead },
										   { "counts", Access::ComputeRead },
										   { "full_clusters", Access::ComputeRead },
										   { "batches", Access::ComputeRead, &kTessellates },
										   { "visibility_buffer", Access::ComputeWrite },
									   } });

static void rasterPhase(PassContext& pass, uint32_t phase)
{
	RasterMicroArgs args = {};
	args.inputs = rasterInputs(pass);
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.full_clusters = pass.address("full_clusters");
	args.batches = pass.address("batches");
	args.visibility = pass.address("visibility_buffer");
	args.phase = phase;
	pass.dispatchLoop(args, uint64_t(pass.capacity("batches")) + pass.capacity("full_clusters"));
}

static void record(PassContext& pass)
{
	rasterPhase(pass, PHASE_FIRST);
}

static void recordSecond(PassContext& pass)
{
	rasterPhase(pass, PHASE_SECOND);
}

static constexpr const Condition* kNeeded[] = { &kSoft };
static constexpr const Condition* kSecondNeeded[] = { &kLooksForHidden };
static constexpr std::string_view kShaders[] = { "raster/raster_micro.comp" };

const PassDesc kRasterMicro = { "raster_micro", kUses, kNeeded, kShaders, nullptr, record };
// What retest_parts found to be seen after all.
const PassDesc kRasterRevealed = { "raster_revealed", kUses, kSecondNeeded, kShaders, nullptr, recordSecond };

}  // namespace tessera
