// Arguments of batch_parts.
#ifndef TESSERA_TESSELLATION_BATCH_PARTS_H
#define TESSERA_TESSELLATION_BATCH_PARTS_H
#include "shared/lists.h"
#include "shared/pattern.h"

SHARED_BEGIN

struct BatchPartsArgs
{
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(DomainTriangle) part_triangles;
	GPU_PTR(PatternRange) patterns;
	GPU_PTR(Batch) batches;
};
SHARED_LAYOUT(BatchPartsArgs, 40, batches, 32)

SHARED_END

#endif
