#include "raster/draw_clusters.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr auto kUses = joinUses(surfaceUses(Access::MeshRead), std::array<Use, 7>{ {
																		  { "heads", Access::MeshRead },
																		  { "heads", Access::Indirect },
																		  { "full_clusters", Access::MeshRead },
																		  { "micro_vertices", Access::MeshRead },
																		  { "visible_clusters", Access::FragmentRead },
																		  { "visibility_depth", Access::Depth },
																		  { "visibility_payload", Access::Color },
																	  } });

static void record(PassContext& pass)
{
	DrawClustersArgs args = {};
	args.inputs = rasterInputs(pass, ReadsParts::No);
	args.heads = pass.address("heads");
	args.full_clusters = pass.address("full_clusters");
	args.vertices = pass.address("micro_vertices");
	pass.drawMeshTasks(args, "full_clusters");
}

static constexpr const Condition* kNeeded[] = { &kMesh };
static constexpr std::string_view kShaders[] = { "raster/draw_clusters.mesh", "raster/draw_clusters.frag" };

const PassDesc kDrawClusters = { "draw_clusters", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
