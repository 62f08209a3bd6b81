// material_record.h: a material's colour side, as shade reads it.
#ifndef TESSERA_SHADING_MATERIAL_RECORD_H
#define TESSERA_SHADING_MATERIAL_RECORD_H
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct MaterialRecord
{
	vec4 base_color;  // linear
	vec3 emissive;
	float metallic;
	float roughness;
	uint color_texture;  // into the bindless set; NO_INDEX: none
};
SHARED_LAYOUT(MaterialRecord, 40, color_texture, 36)

SHARED_END

#endif
