#include "raster/raster_micro.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr auto kItemUses = joinUses(surfaceUses(Access::ComputeRead), partUses(Access::ComputeRead),
										   std::array<Use, 4>{ {
											   { "heads", Access::ComputeRead },
											   { "full_clusters", Access::ComputeRead },
											   { "batches", Access::ComputeRead, &kTessellates },
											   { "visibility_buffer", Access::ComputeWrite },
										   } });
static constexpr auto kSmallUses = joinUses(kItemUses, std::array<Use, 2>{ {
														   { "counts", Access::ComputeWrite },
														   { "left_items", Access::ComputeWrite },
													   } });
static constexpr auto kMicroUses = joinUses(kItemUses, std::array<Use, 2>{ {
														   { "counts", Access::ComputeRead },
														   { "left_items", Access::ComputeRead, &kSmallFirst },
													   } });
static constexpr auto kRevealedUses = joinUses(kItemUses, std::array<Use, 1>{ { { "counts", Access::ComputeRead } } });

static void rasterPhase(PassContext& pass, uint32_t phase, bool takes_left)
{
	RasterMicroArgs args = {};
	args.inputs = rasterInputs(pass);
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.full_clusters = pass.address("full_clusters");
	args.batches = pass.address("batches");
	args.visibility = pass.address("visibility_buffer");
	args.left_items = pass.addressOr0("left_items", takes_left);
	args.phase = phase;
	pass.dispatchLoop(args, uint64_t(pass.capacity("batches")) + pass.capacity("full_clusters"));
}

static void recordSmall(PassContext& pass)
{
	rasterPhase(pass, PHASE_FIRST, true);
}

static void record(PassContext& pass)
{
	rasterPhase(pass, PHASE_FIRST, kSmallFirst.holds(pass.input()));
}

static void recordSecond(PassContext& pass)
{
	rasterPhase(pass, PHASE_SECOND, false);
}

static constexpr const Condition* kNeeded[] = { &kSoft };
static constexpr const Condition* kSmallNeeded[] = { &kSmallFirst };
static constexpr const Condition* kSecondNeeded[] = { &kLooksForHidden };
static constexpr std::string_view kShaders[] = { "raster/raster_micro.comp" };
static constexpr std::string_view kSmallShaders[] = { "raster/raster_small.comp" };

const PassDesc kRasterSmall = { "raster_small", kSmallUses, kSmallNeeded, kSmallShaders, nullptr, recordSmall };
const PassDesc kRasterMicro = { "raster_micro", kMicroUses, kNeeded, kShaders, nullptr, record };
// What retest_parts found to be seen after all.
const PassDesc kRasterRevealed = { "raster_revealed", kRevealedUses, kSecondNeeded, kShaders, nullptr, recordSecond };

}  // namespace tessera
