// Arguments of triangle_split.
#ifndef TESSERA_TESSELLATION_TRIANGLE_SPLIT_H
#define TESSERA_TESSELLATION_TRIANGLE_SPLIT_H
#include "shared/bounds.h"
#include "shared/edge_factor.h"
#include "shared/geometry.h"
#include "shared/lists.h"
#include "shared/pattern.h"

SHARED_BEGIN

struct TriangleSplitArgs
{
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(ClusterRecord) clusters;
	GPU_PTR(DisplacedBounds) cluster_bounds;  // 0 without culling
	GPU_PTR(vec3) positions;
	GPU_PTR(uint) triangles;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(ClusterRef) visible_clusters;
	GPU_PTR(DomainTriangle) split_triangles;
	GPU_PTR(DomainTriangle) part_triangles;
	TableView table;
	FactorRule rule;
	uint level;  // which level of split_triangles is taken apart
	uint cull_frustum;
	uint last_level;  // 1: what still exceeds the table after this level has nowhere to go (the frame is planned again)
};
SHARED_LAYOUT(TriangleSplitArgs, 128, last_level, 120)

SHARED_END

#endif
