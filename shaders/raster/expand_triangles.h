// Arguments of expand_triangles.
#ifndef TESSERA_RASTER_EXPAND_TRIANGLES_H
#define TESSERA_RASTER_EXPAND_TRIANGLES_H
#include "shared/lists.h"
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct ExpandTrianglesArgs
{
	RasterInputs inputs;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(uint) full_clusters;
	GPU_PTR(uint) batches;  // 0 when nothing is tessellated
	GPU_PTR(vec4) vertices; // clip coordinates
	GPU_PTR(uint) indices;  // 3 per micro-triangle
};
SHARED_LAYOUT(ExpandTrianglesArgs, 128, indices, 120)

SHARED_END

#endif
