#include "raster/draw_indexed.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

// Evaluation happened in evaluate_vertices; only telling sides apart needs more than vertices, indices and payloads.
static constexpr Use kUses[] = {
	{ "view", Access::VertexRead, &kRays },
	{ "micro_vertices", Access::VertexRead },
	{ "expanded_triangles", Access::IndexRead },
	{ "expanded_triangles", Access::FragmentRead },
	{ "indexed_draw", Access::Indirect },
	{ "visible_clusters", Access::FragmentRead },
	{ "part_triangles", Access::FragmentRead, &kTessellates },
	{ "clusters", Access::FragmentRead },
	{ "material_flags", Access::FragmentRead },
	{ "visibility_depth", Access::Depth },
	{ "visibility_payload", Access::Color },
};

static void record(PassContext& pass)
{
	DrawIndexedArgs args = {};
	args.inputs.clusters = pass.address("clusters");
	args.inputs.visible_clusters = pass.address("visible_clusters");
	args.inputs.part_triangles = pass.address("part_triangles");
	args.inputs.material_flags = pass.address("material_flags");
	args.vertices = pass.address("micro_vertices");
	args.expanded_triangles = pass.address("expanded_triangles");
	args.first_payload = 3 * pass.capacity("expanded_triangles");
	pass.drawIndexed(args, "expanded_triangles", "indexed_draw");
}

static constexpr const Condition* kNeeded[] = { &kIndexed, &kPrimitiveId };
static constexpr std::string_view kShaders[] = { "raster/draw_indexed.vert", "raster/draw_indexed.frag" };

const PassDesc kDrawIndexed = { "draw_indexed", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
