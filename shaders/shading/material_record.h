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

// What only shading reads, per vertex and per material. Absent arrays (address 0) are not needed by the scene.
struct ShadingData
{
	GPU_PTR(vec3) normals;  // authored shading normals, mesh units
	GPU_PTR(vec2) color_uvs;
	GPU_PTR(uint) colors;  // RGBA8, linear
	GPU_PTR(MaterialRecord) materials;
};
SHARED_LAYOUT(ShadingData, 32, materials, 24)

SHARED_END

#endif
