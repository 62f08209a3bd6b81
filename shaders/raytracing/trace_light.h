// Arguments of trace_shadows and trace_ambient.
#ifndef TESSERA_RAYTRACING_TRACE_LIGHT_H
#define TESSERA_RAYTRACING_TRACE_LIGHT_H
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct TraceLightArgs
{
	RasterInputs inputs;
	uint64_t visibility;   // address of a 64-bit word per pixel; 0 when attachments hold depth and payload
	GPU_PTR(float) light;  // per pixel: how much of it arrives, 0..1; not written where nothing is seen
	uint samples;          // of trace_ambient
	float radius_world;    // what is farther does not occlude
	float more_offset;     // of rays' origins, where clusters' positions lose bits; of the triangle's largest coordinate
	uint unused;
};
SHARED_LAYOUT(TraceLightArgs, 104, unused, 100)

SHARED_END

#endif
