// Arguments of raster_small and raster_micro.
#ifndef TESSERA_RASTER_RASTER_MICRO_H
#define TESSERA_RASTER_RASTER_MICRO_H
#include "shared/lists.h"
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct RasterMicroArgs
{
	RasterInputs inputs;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(Batch) batches;    // 0 when nothing is tessellated
	uint64_t visibility;       // address of a 64-bit word per pixel: depth << 32 | payload
	GPU_PTR(uint) left_items;  // 0 where raster_micro takes all items itself
	uint phase;                // PHASE_FIRST or PHASE_SECOND
};
SHARED_LAYOUT(RasterMicroArgs, 128, phase, 120)

SHARED_END

#endif
