// Arguments of batch_parts.
#ifndef TESSERA_TESSELLATION_BATCH_PARTS_H
#define TESSERA_TESSELLATION_BATCH_PARTS_H
#include "shared/bounds.h"
#include "shared/geometry.h"
#include "shared/lists.h"
#include "shared/pattern.h"

SHARED_BEGIN

struct BatchPartsArgs
{
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(DomainTriangle) part_triangles;  // 0 when nothing is tessellated
	GPU_PTR(PatternRange) patterns;
	GPU_PTR(Batch) batches;
	GPU_PTR(PartPlace) part_places;
	GPU_PTR(uint) window_seen;  // per window of BATCH_WINDOW parts; this and all below: 0 without occlusion culling
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(ClusterRecord) clusters;
	GPU_PTR(DisplacedBounds) cluster_bounds;
	GPU_PTR(TriangleReach) triangle_reaches;  // per triangle; 0 when nothing is displaced
	GPU_PTR(ClusterRef) visible_clusters;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(uint) window_vertices;  // per window: its first micro-vertex; 0 where nothing is built from clusters
	uint most_parts;                // of a batch, at most BATCH_MAX_PARTS
	uint most_vertices;
	uint most_triangles;
	uint second_phase;  // 1: what was hidden is tested against this frame's pyramid
};
SHARED_LAYOUT(BatchPartsArgs, 128, second_phase, 124)

SHARED_END

#endif
