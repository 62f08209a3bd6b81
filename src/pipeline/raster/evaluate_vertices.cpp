#include "raster/evaluate_vertices.h"

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
										   { "micro_vertices", Access::ComputeWrite },
										   { "expanded_triangles", Access::ComputeWrite, &kExpands },
									   } });

static void record(PassContext& pass)
{
	EvaluateVerticesArgs args = {};
	args.inputs = rasterInputs(pass);
	args.heads = pass.address("heads");
	args.counts = pass.address("counts");
	args.full_clusters = pass.address("full_clusters");
	args.batches = pass.address("batches");
	args.vertices = pass.address("micro_vertices");
	args.indices = pass.address("expanded_triangles");
	args.traced_triangles = kRayTriangles.holds(pass.input()) ? pass.tracedTriangles() : 0;
	pass.dispatchLoop(args, uint64_t(pass.capacity("batches")) + pass.capacity("full_clusters"));
}

static constexpr const Condition* kNeeded[] = { &kKeepsVertices };
static constexpr std::string_view kShaders[] = { "raster/evaluate_vertices.comp" };

const PassDesc kEvaluateVertices = { "evaluate_vertices", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
