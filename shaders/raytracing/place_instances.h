// Instances of the scene that rays are traced through, as builds read them, and the arguments of place_instances.
#ifndef TESSERA_RAYTRACING_PLACE_INSTANCES_H
#define TESSERA_RAYTRACING_PLACE_INSTANCES_H
#include "raytracing/cluster_lists.h"
#include "shared/lists.h"
#include "shared/ray_sharing.h"
#include "shared/view.h"

SHARED_BEGIN

// VkAccelerationStructureInstanceKHR.
struct RayInstance
{
	vec4 row0;  // 3 x 4 matrix from the structure's space to that of the rays
	vec4 row1;
	vec4 row2;
	uint index_and_mask;    // what hits are told, 24 bits; mask << 24
	uint offset_and_flags;  // of the shader table, 24 bits; RAY_INSTANCE_* << 24
	uint64_t structure;     // address; 0: inactive
};
SHARED_LAYOUT(RayInstance, 64, structure, 56)

// Without it a triangle is seen from where it runs counter-clockwise. VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR.
#define RAY_INSTANCE_TURNED 2u

struct PlaceInstancesArgs
{
	GPU_PTR(RayInstance) instances;
	uint64_t geometry;                        // address of the structure of the frame's micro-triangles; 0: there are clusters
	GPU_PTR(InstanceRecord) scene_instances;  // 0 without clusters and shared structures
	GPU_PTR(ClusterWork) work;                // 0 without clusters
	GPU_PTR(uint) shared_instances;           // this and the next: 0 without shared structures
	GPU_PTR(uvec2) mesh_structures;           // per mesh, the address of its structure, lower word first
	GPU_PTR(FrameCounts) counts;              // likewise
	uint scene_instance_count;
	uint unused;
};
SHARED_LAYOUT(PlaceInstancesArgs, 64, unused, 60)

SHARED_END

#endif
