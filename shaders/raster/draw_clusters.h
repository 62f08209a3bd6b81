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
	GPU_PTR(uint) full_clusters;
};
SHARED_LAYOUT(DrawClustersArgs, 96, full_clusters, 88)

SHARED_END

#endif
