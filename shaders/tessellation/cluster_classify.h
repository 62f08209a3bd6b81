// Arguments of cluster_classify.
#ifndef TESSERA_TESSELLATION_CLUSTER_CLASSIFY_H
#define TESSERA_TESSELLATION_CLUSTER_CLASSIFY_H
#include "shared/edge_factor.h"
#include "shared/geometry.h"
#include "shared/lists.h"

SHARED_BEGIN

struct ClusterClassifyArgs
{
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(ClusterRecord) clusters;
	GPU_PTR(vec3) positions;
	GPU_PTR(uint) triangles;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(ClusterRef) visible_clusters;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(DomainTriangle) split_triangles;  // 0 when no split can occur
	GPU_PTR(DomainTriangle) part_triangles;
	FactorRule rule;
};
SHARED_LAYOUT(ClusterClassifyArgs, 88, rule, 80)

SHARED_END

#endif
