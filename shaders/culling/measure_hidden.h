// Arguments of measure_hidden.
#ifndef TESSERA_CULLING_MEASURE_HIDDEN_H
#define TESSERA_CULLING_MEASURE_HIDDEN_H
#include "shared/bounds.h"
#include "shared/hidden.h"
#include "shared/lists.h"

SHARED_BEGIN

struct MeasureHiddenArgs
{
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(DisplacedBounds) mesh_bounds;
	GPU_PTR(HiddenInstance) hidden_instances;
	GPU_PTR(HiddenInstance) hidden_instances_next;
	GPU_PTR(FrameCounts) counts;
	uint64_t visibility;  // address of a 64-bit word per pixel: depth << 32 | payload
	uint instance_count;
	uint unused;
};
SHARED_LAYOUT(MeasureHiddenArgs, 56, unused, 52)

SHARED_END

#endif
