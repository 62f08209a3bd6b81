// Arguments of cluster_classify.
#ifndef TESSERA_TESSELLATION_CLUSTER_CLASSIFY_H
#define TESSERA_TESSELLATION_CLUSTER_CLASSIFY_H
#include "shared/bounds.h"
#include "shared/edge_factor.h"
#include "shared/geometry.h"
#include "shared/lists.h"
#include "shared/ray_sharing.h"

SHARED_BEGIN

struct ClusterClassifyArgs
{
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(ClusterRecord) clusters;
	GPU_PTR(DisplacedBounds) cluster_bounds;  // 0 without culling
	GPU_PTR(vec3) positions;
	GPU_PTR(uint) triangles;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(ClusterRef) visible_clusters;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(DomainTriangle) split_triangles;  // 0 when no split can occur
	GPU_PTR(DomainTriangle) part_triangles;
	GPU_PTR(uint) shared_instances;  // with structures that instances share
	FactorRule rule;
	uint cull_frustum;
};
SHARED_LAYOUT(ClusterClassifyArgs, 112, cull_frustum, 104)

SHARED_END

#endif
