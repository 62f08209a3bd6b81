#include "culling/instance_classify.h"

#include "frame/shared_structures.h"
#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kUses[] = {
	{ "view", Access::ComputeRead },
	{ "instances", Access::ComputeRead },
	{ "meshes", Access::ComputeRead },
	{ "mesh_bounds", Access::ComputeRead, &kBoundsMeshes },
	{ "heads", Access::ComputeWrite },
	{ "cluster_groups", Access::ComputeWrite },
	{ "counts", Access::ComputeWrite, &kSharesStructures },
	{ "mesh_addresses", Access::ComputeRead, &kSharesStructures },
	{ "shared_instances", Access::ComputeWrite, &kSharesStructures },
};

static void record(PassContext& pass)
{
	InstanceClassifyArgs args = {};
	args.instances = pass.address("instances");
	args.meshes = pass.address("meshes");
	args.mesh_bounds = pass.address("mesh_bounds");
	args.heads = pass.address("heads");
	args.cluster_groups = pass.address("cluster_groups");
	args.cull_frustum = kFrustumCulls.holds(pass.input()) ? 1 : 0;
	if (kSharesStructures.holds(pass.input()))
	{
		args.counts = pass.address("counts");
		args.shared_instances = pass.address("shared_instances");
		args.mesh_structures = pass.sharedStructures().addresses();
		args.sharing = pass.raySharing();
	}
	args.instance_count = static_cast<uint32_t>(pass.input().sizes.instances);
	args.round = pass.round();
	args.round_count = pass.input().view.rounds;
	args.groups_per_mesh = static_cast<uint32_t>(pass.input().sizes.most_groups_per_mesh);
	pass.dispatchLoop(args, args.instance_count, 64);
}

static constexpr std::string_view kShaders[] = { "culling/instance_classify.comp" };

const PassDesc kInstanceClassify = { "instance_classify", kUses, {}, kShaders, nullptr, record };

}  // namespace tessera
