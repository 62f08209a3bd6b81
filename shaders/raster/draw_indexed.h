// Arguments of draw_indexed.
#ifndef TESSERA_RASTER_DRAW_INDEXED_H
#define TESSERA_RASTER_DRAW_INDEXED_H
#include "shared/lists.h"
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct DrawIndexedArgs
{
	RasterInputs inputs;
	GPU_PTR(vec4) vertices;
	GPU_PTR(uint) expanded_triangles;
	uint first_payload;  // where the payloads begin in it
};
SHARED_LAYOUT(DrawIndexedArgs, 96, first_payload, 88)

SHARED_END

#endif
