// Arguments of cluster_cull.
#ifndef TESSERA_CULLING_CLUSTER_CULL_H
#define TESSERA_CULLING_CLUSTER_CULL_H
#include "shared/bounds.h"
#include "shared/geometry.h"
#include "shared/lists.h"
#include "shared/ray_sharing.h"

SHARED_BEGIN

struct ClusterCullArgs
{
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(ClusterRecord) clusters;
	GPU_PTR(DisplacedBounds) cluster_bounds;  // 0 without culling
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(ClusterGroup) cluster_groups;
	GPU_PTR(ClusterRef) visible_clusters;
	GPU_PTR(FullCluster) full_clusters;  // 0 when cluster_classify decides which clusters are full
	GPU_PTR(MeshRecord) meshes;          // this and the next two: with structures that instances share
	GPU_PTR(uint) shared_instances;
	GPU_PTR(uint) shared_clusters;  // 0: no primary rays ask
	uint cull_frustum;
	uint cull_backface;
	uint emit_full;  // 1: no factor can exceed 1, every visible cluster is full
};
SHARED_LAYOUT(ClusterCullArgs, 104, emit_full, 96)

SHARED_END

#endif
