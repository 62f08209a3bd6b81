#include "raster/dump_micro.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr auto kUses = joinUses(surfaceUses(Access::ComputeRead), partUses(Access::ComputeRead),
									   std::array<Use, 7>{ {
										   { "shading", Access::ComputeRead },
										   { "normals", Access::ComputeRead, &kNormals },
										   { "heads", Access::ComputeRead },
										   { "counts", Access::ComputeRead },
										   { "full_clusters", Access::ComputeRead },
										   { "batches", Access::ComputeRead, &kTessellates },
										   { "micro_dump", Access::ComputeWrite },
									   } });

static void record(PassContext& pass)
{
	DumpMicroArgs args = {};
	args.inputs = rasterInputs(pass);
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.full_clusters = pass.address("full_clusters");
	args.batches = pass.address("batches");
	args.shading = pass.address("shading");
	args.dump = pass.address("micro_dump");
	pass.dispatchLoop(args, uint64_t(pass.capacity("batches")) + pass.capacity("full_clusters"));
}

static constexpr std::string_view kShaders[] = { "raster/dump_micro.comp" };

const PassDesc kDumpMicro = { "dump_micro", kUses, {}, kShaders, nullptr, record };

}  // namespace tessera
