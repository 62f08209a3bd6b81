// Arguments of shade.
#ifndef TESSERA_SHADING_SHADE_H
#define TESSERA_SHADING_SHADE_H
#include "shading/material_record.h"
#include "shared/lists.h"

SHARED_BEGIN

// Order of ViewMode in src/plan/render_options.h.
#define VIEW_SHADED 0u
#define VIEW_CLUSTERS 1u
#define VIEW_PARTS 2u
#define VIEW_TRIANGLES 3u
#define VIEW_FACTORS 4u
#define VIEW_DEPTH 5u
#define VIEW_NORMALS 6u
#define VIEW_WIREFRAME 7u
#define VIEW_FACETS 8u
#define VIEW_HEIGHT 9u
#define VIEW_INSTANCES 10u
#define VIEW_MATERIALS 11u
#define VIEW_PRIMITIVES 12u
#define VIEW_AREA 13u
#define VIEW_ERROR 14u
#define VIEW_WITH_WIREFRAME 256u  // added to any of them

struct ShadeArgs
{
	RasterInputs inputs;
	GPU_PTR(ShadingData) shading;
	GPU_PTR(uint) picture;  // RGBA8, sRGB-encoded
	GPU_PTR(FrameCounts) counts;
	uint64_t visibility;                // address of a 64-bit word per pixel; 0 when attachments hold depth and payload
	uint view_mode;                     // VIEW_*
	uint rounds;                        // round | round_count << 16
	GPU_PTR(float) sun_visibility;      // per pixel, 0..1; 0: no shadows are traced
	GPU_PTR(float) ambient_visibility;  // 0: no ambient occlusion is traced
};
SHARED_LAYOUT(ShadeArgs, 128, ambient_visibility, 120)

SHARED_END

#endif
