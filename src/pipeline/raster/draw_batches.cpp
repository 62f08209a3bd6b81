#include "raster/draw_batches.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr auto kUses = joinUses(surfaceUses(Access::MeshRead), partUses(Access::MeshRead),
									   std::array<Use, 8>{ {
										   { "heads", Access::MeshRead },
										   { "heads", Access::Indirect },
										   { "batches", Access::MeshRead },
										   { "micro_vertices", Access::MeshRead },
										   { "visible_clusters", Access::FragmentRead },
										   { "part_triangles", Access::FragmentRead },
										   { "visibility_depth", Access::Depth },
										   { "visibility_payload", Access::Color },
									   } });

static void record(PassContext& pass)
{
	DrawBatchesArgs args = {};
	args.inputs = rasterInputs(pass);
	args.heads = pass.address("heads");
	args.batches = pass.address("batches");
	args.vertices = pass.address("micro_vertices");
	pass.drawMeshTasks(args, "batches");
}

static constexpr const Condition* kNeeded[] = { &kMesh, &kTessellates };
static constexpr std::string_view kShaders[] = { "raster/draw_batches.mesh", "raster/draw_batches.frag" };

const PassDesc kDrawBatches = { "draw_batches", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
