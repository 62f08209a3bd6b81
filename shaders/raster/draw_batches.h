// Arguments of draw_batches.
#ifndef TESSERA_RASTER_DRAW_BATCHES_H
#define TESSERA_RASTER_DRAW_BATCHES_H
#include "shared/lists.h"
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct DrawBatchesArgs
{
	RasterInputs inputs;
	GPU_PTR(ListHead) heads;
	GPU_PTR(Batch) batches;
	GPU_PTR(vec4) vertices;
};
SHARED_LAYOUT(DrawBatchesArgs, 96, vertices, 88)

SHARED_END

#endif
