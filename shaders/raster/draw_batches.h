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
	GPU_PTR(uint) batches;
};
SHARED_LAYOUT(DrawBatchesArgs, 96, batches, 88)

SHARED_END

#endif
