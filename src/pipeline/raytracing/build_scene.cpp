#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "ray_instances", Access::BuildRead }, { "ray_geometry", Access::BuildRead }, { "mesh_structures", Access::BuildRead, &kSharesStructures },
	{ "ray_scene", Access::BuildWrite },    { "ray_scratch", Access::BuildWrite },
};

static void record(PassContext& pass)
{
	pass.build("ray_scene");
}

static constexpr const Condition* kNeeded[] = { &kRays };

// The top-level structure, which rays are traced through; the driver builds it.
const PassDesc kBuildScene = { "build_scene", kUses, kNeeded, {}, nullptr, record };

}  // namespace tessera
