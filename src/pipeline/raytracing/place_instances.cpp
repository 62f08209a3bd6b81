#include "raytracing/place_instances.h"

#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "ray_instances", Access::ComputeWrite },
};

static void record(PassContext& pass)
{
	const PlaceInstancesArgs args = { pass.address("ray_instances"), pass.tracedGeometry() };
	pass.dispatch(args, 1);
}

static constexpr const Condition* kNeeded[] = { &kRays };
static constexpr std::string_view kShaders[] = { "raytracing/place_instances.comp" };

const PassDesc kPlaceInstances = { "place_instances", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
