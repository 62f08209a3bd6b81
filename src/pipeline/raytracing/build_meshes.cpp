// expand_meshes and build_meshes: structures of meshes in their own space, which instances share, in the frame that first needs them.
#include "frame/shared_structures.h"
#include "pipeline/passes.h"
#include "pipeline/uses.h"
#include "raytracing/expand_meshes.h"

namespace tessera
{

static constexpr auto kExpandUses = joinUses(surfaceUses(Access::ComputeRead), std::array<Use, 1>{ { { "mesh_inputs", Access::ComputeWrite } } });
static constexpr Use kBuildUses[] = {
	{ "mesh_inputs", Access::BuildRead },
	{ "mesh_structures", Access::BuildWrite },
	{ "ray_scratch", Access::BuildWrite },
};

static void recordExpand(PassContext& pass)
{
	ExpandMeshesArgs args = {};
	args.clusters = pass.address("clusters");
	args.vertices = pass.sharedStructures().vertices();
	args.indices = pass.sharedStructures().indices();
	for (const ExpandedMesh& mesh : pass.sharedStructures().expanded())
	{
		args.first_cluster = mesh.first_cluster;
		args.cluster_count = mesh.cluster_count;
		args.vertex_place = mesh.vertex_place;
		args.triangle_place = mesh.triangle_place;
		pass.dispatchLoop(args, mesh.cluster_count);
	}
}

static void recordBuild(PassContext& pass)
{
	pass.sharedStructures().recordBuilds(pass.commands());
}

static constexpr const Condition* kNeeded[] = { &kMakesStructures };
static constexpr std::string_view kShaders[] = { "raytracing/expand_meshes.comp" };

const PassDesc kExpandMeshes = { "expand_meshes", kExpandUses, kNeeded, kShaders, nullptr, recordExpand };
const PassDesc kBuildMeshes = { "build_meshes", kBuildUses, kNeeded, {}, nullptr, recordBuild };

}  // namespace tessera
