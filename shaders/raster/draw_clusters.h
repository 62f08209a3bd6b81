// Arguments of draw_clusters.
#ifndef TESSERA_RASTER_DRAW_CLUSTERS_H
#define TESSERA_RASTER_DRAW_CLUSTERS_H
#include "shared/lists.h"
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct DrawClustersArgs
{
	RasterInputs inputs;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(vec4) vertices;
};
SHARED_LAYOUT(DrawClustersArgs, 96, vertices, 88)

SHARED_END

#endif
