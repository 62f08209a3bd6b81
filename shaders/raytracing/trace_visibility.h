// Arguments of trace_visibility.
#ifndef TESSERA_RAYTRACING_TRACE_VISIBILITY_H
#define TESSERA_RAYTRACING_TRACE_VISIBILITY_H
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct TraceVisibilityArgs
{
	RasterInputs inputs;
	GPU_PTR(uint) payloads;  // expanded_triangles, or those of transient clusters
	uint64_t visibility;     // address of a 64-bit word per pixel: depth << 32 | payload
	uint first_payload;      // where they begin
	uint unused;
};
SHARED_LAYOUT(TraceVisibilityArgs, 96, unused, 92)

SHARED_END

#endif
