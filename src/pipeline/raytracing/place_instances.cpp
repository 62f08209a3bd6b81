#include "raytracing/place_instances.h"

#include "frame/ray_clusters.h"
#include "frame/shared_structures.h"
#include "pipeline/passes.h"
#include "pipeline/uses.h"

#include <algorithm>

namespace tessera
{

static constexpr Use kUses[] = {
	{ "instances", Access::ComputeRead, &kPlacesInstances },
	{ "view", Access::ComputeRead, &kSharesStructures },
	{ "shared_instances", Access::ComputeRead, &kSharesStructures },
	{ "mesh_addresses", Access::ComputeRead, &kSharesStructures },
	{ "counts", Access::ComputeRead, &kSharesStructures },
	{ "instance_clusters", Access::ComputeRead, &kClusters },
	{ "ray_references", Access::ComputeRead, &kClusters },
	{ "cluster_counts", Access::ComputeWrite, &kClusters },
	{ "ray_instances", Access::ComputeWrite },
};

static void record(PassContext& pass)
{
	PlaceInstancesArgs args = {};
	args.instances = pass.address("ray_instances");
	args.scene_instances = pass.address("instances");
	if (!kClusters.holds(pass.input()))
	{
		args.geometry = pass.tracedGeometry();
		if (kSharesStructures.holds(pass.input()))
		{
			args.shared_instances = pass.address("shared_instances");
			args.mesh_structures = pass.sharedStructures().addresses();
			args.counts = pass.address("counts");
			args.scene_instance_count = static_cast<uint32_t>(pass.input().sizes.instances);
		}
		pass.dispatchLoop(args, std::max(args.scene_instance_count, 1u), kThreadsOfAnyGroup);
		return;
	}
	args.work = pass.clusters().work();
	pass.dispatchLoop(args, pass.clusters().sceneInstances(), kThreadsOfAnyGroup);
}

static constexpr const Condition* kNeeded[] = { &kRays };
static constexpr std::string_view kShaders[] = { "raytracing/place_instances.comp" };

const PassDesc kPlaceInstances = { "place_instances", kUses, kNeeded, kShaders, nullptr, record };

}  // namespace tessera
