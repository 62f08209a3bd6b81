#include "raytracing/place_instances.h"

#include "frame/ray_clusters.h"
#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "instances", Access::ComputeRead, &kClusters },
	{ "instance_clusters", Access::ComputeRead, &kClusters },
	{ "ray_references", Access::ComputeRead, &kClusters },
	{ "cluster_counts", Access::ComputeWrite, &kClusters },
	{ "ray_instances", Access::ComputeWrite },
};

static void record(PassContext& pass)
{
	PlaceInstancesArgs args = {};
	args.instances = pass.address("ray_instances");
	if (!kClusters.holds(pass.input()))
	{
		args.geometry = pass.tracedGeometry();
		pass.dispatch(args, 1);
		return;
	}
	args.scene_instances = pass.address("instances");
	args.work = pass.clusters().work();
	pass.dispatchLoop(args, pass.clusters().sceneInstances(), kThreadsOfAnyGroup);
}

static constexpr const Condition* kNeeded[] = { &kRays };
static constexpr std::string_view kShaders[] = { "raytracing/place_instances.comp" };

const PassDesc kPlaceInstances = { "place_instances", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
