// Arguments of list_clusters.
#ifndef TESSERA_RAYTRACING_LIST_CLUSTERS_H
#define TESSERA_RAYTRACING_LIST_CLUSTERS_H
#include "raytracing/cluster_lists.h"
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct ListClustersArgs
{
	RasterInputs inputs;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(uint) window_vertices;  // per window of BATCH_WINDOW parts: its first micro-vertex; 0 when nothing is tessellated
	GPU_PTR(vec4) vertices;
	GPU_PTR(ClusterWork) work;
};
SHARED_LAYOUT(ListClustersArgs, 120, work, 112)

SHARED_END

#endif
