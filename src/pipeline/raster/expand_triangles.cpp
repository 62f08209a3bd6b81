#include "raster/expand_triangles.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr auto kUses = joinUses(surfaceUses(Access::ComputeRead), partUses(Access::ComputeRead),
                                       std::array<Use, 6>{ {
										   { "heads", Access::ComputeRead },
										   { "counts", Access::ComputeWrite },
										   { "full_clusters", Access::ComputeRead },
										   { "batches", Access::ComputeRead, &kTessellates },
										   { "expanded_vertices", Access::ComputeWrite },
										   { "expanded_triangles", Access::ComputeWrite },
									   } });

static void record(PassContext& pass)
{
	ExpandTrianglesArgs args = {};
	args.inputs = rasterInputs(pass);
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.full_clusters = pass.address("full_clusters");
	args.batches = pass.address("batches");
	args.vertices = pass.address("expanded_vertices");
	args.indices = pass.address("expanded_triangles");
	pass.dispatchLoop(args, uint64_t(pass.capacity("batches")) + pass.capacity("full_clusters"));
}

static constexpr const Condition* kNeeded[] = { &kIndexed, &kPrimitiveId };
static constexpr std::string_view kShaders[] = { "raster/expand_triangles.comp" };

const PassDesc kExpandTriangles = { "expand_triangles", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
