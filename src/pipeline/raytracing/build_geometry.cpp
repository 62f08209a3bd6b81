#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "micro_vertices", Access::BuildRead },
	{ "expanded_triangles", Access::BuildRead },
	{ "ray_geometry", Access::BuildWrite },
	{ "ray_scratch", Access::BuildWrite },
};

static void record(PassContext& pass)
{
	pass.build("ray_geometry");
}

static constexpr const Condition* kNeeded[] = { &kRayTriangles };

// The bottom-level structure of the frame's micro-triangles; the driver builds it.
const PassDesc kBuildGeometry = { "build_geometry", kUses, kNeeded, {}, nullptr, record };

}  // namespace tessera
