// Instances of the scene that rays are traced through, as builds read them, and the arguments of place_instances.
#ifndef TESSERA_RAYTRACING_PLACE_INSTANCES_H
#define TESSERA_RAYTRACING_PLACE_INSTANCES_H
#include "shared/lang.h"

SHARED_BEGIN

// VkAccelerationStructureInstanceKHR.
struct RayInstance
{
	vec4 row0;  // 3 x 4 matrix from the structure's space to that of the rays
	vec4 row1;
	vec4 row2;
	uint index_and_mask;    // what hits are told, 24 bits; mask << 24
	uint offset_and_flags;  // of the shader table, 24 bits; flags << 24: none, a triangle is seen from where it runs counter-clockwise
	uint64_t structure;     // address; 0: inactive
};
SHARED_LAYOUT(RayInstance, 64, structure, 56)

struct PlaceInstancesArgs
{
	GPU_PTR(RayInstance) instances;
	uint64_t geometry;  // address of the structure of the frame's micro-triangles
};
SHARED_LAYOUT(PlaceInstancesArgs, 16, geometry, 8)

SHARED_END

#endif
