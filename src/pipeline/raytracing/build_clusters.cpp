// instantiate_clusters, build_transients and build_structures: the driver builds what list_clusters and list_structures have listed.
#include "frame/ray_clusters.h"
#include "pipeline/passes.h"
#include "pipeline/uses.h"

namespace tessera
{

static constexpr Use kInstantiateUses[] = {
	{ "cluster_counts", Access::BuildRead },    { "ray_inputs", Access::BuildRead },    { "micro_vertices", Access::BuildRead },
	{ "cluster_templates", Access::BuildRead }, { "ray_clusters", Access::BuildWrite }, { "ray_scratch", Access::BuildWrite },
};
static constexpr Use kTransientUses[] = {
	{ "cluster_counts", Access::BuildRead },
	{ "ray_inputs", Access::BuildRead },
	{ "ray_clusters", Access::BuildWrite },
	{ "ray_scratch", Access::BuildWrite },
};
// The structures lie where the clusters' inputs did.
static constexpr Use kStructureUses[] = {
	{ "cluster_counts", Access::BuildRead }, { "ray_references", Access::BuildWrite }, { "ray_clusters", Access::BuildRead },
	{ "ray_inputs", Access::BuildWrite },    { "ray_geometry", Access::BuildWrite },   { "ray_scratch", Access::BuildWrite },
};

static void recordInstantiate(PassContext& pass)
{
	pass.clusters().recordInstantiations(pass.commands());
}

static void recordTransients(PassContext& pass)
{
	pass.clusters().recordTransients(pass.commands());
}

static void recordStructures(PassContext& pass)
{
	pass.clusters().recordStructures(pass.commands());
}

static constexpr const Condition* kNeeded[] = { &kClusters };
static constexpr const Condition* kTransientsNeeded[] = { &kTransients };

const PassDesc kInstantiateClusters = { "instantiate_clusters", kInstantiateUses, kNeeded, {}, nullptr, recordInstantiate };
const PassDesc kBuildTransients = { "build_transients", kTransientUses, kTransientsNeeded, {}, nullptr, recordTransients };
const PassDesc kBuildStructures = { "build_structures", kStructureUses, kNeeded, {}, nullptr, recordStructures };

}  // namespace tessera
