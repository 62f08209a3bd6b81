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
	GPU_PTR(uint) part_offsets;
	uint most_vertices;  // of a batch
	uint most_triangles;
};
SHARED_LAYOUT(BatchPartsArgs, 56, most_triangles, 52)

SHARED_END

#endif
