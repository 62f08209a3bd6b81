// place_instances: say where the structures lie that rays are traced through.
//
//   out  ray_instances   RayInstance[]   0: the frame's micro-triangles, which are relative to the eye already
//   with structures that instances share (SHARES_STRUCTURES), behind it:
//   in   shared_instances, instances, mesh_structures, counts
//   out  ray_instances   RayInstance[]   one per instance of the scene, inactive where it does not share, or the lists do not hold the frame.
//                                        A structure is in its mesh's space, where the driver looks for the side that a triangle shows:
//                                        mirrored instances are nothing special
//   with clusters (BUILDS_CLUSTERS):
//   in   ray_references  the structures' addresses and sizes, from the driver
//   out  ray_instances   RayInstance[]   one per instance of the scene, inactive where it has no cluster; the same place for all, since vertices
//                                        are relative to the eye; triangles of mirrored ones are turned over here
//
// Host: src/pipeline/raytracing/place_instances.cpp   Test: tests/gpu/raytracing/primary_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x_id = 0) in;
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raytracing/place_instances.h"

layout(push_constant, scalar) uniform Args { PlaceInstancesArgs args; };

shared uint unit_sum;

RayInstance instanceOf(uint64_t structure, uint flags)
{
	RayInstance instance;
	instance.row0 = vec4(1.0, 0.0, 0.0, 0.0);
	instance.row1 = vec4(0.0, 1.0, 0.0, 0.0);
	instance.row2 = vec4(0.0, 0.0, 1.0, 0.0);
	instance.index_and_mask = 0xffu << 24;
	instance.offset_and_flags = flags << 24;
	instance.structure = structure;
	return instance;
}

void placeShared(uint index)
{
	RayInstance placed_instance = instanceOf(0ul, 0u);
	// Of an attempt that does not fit nothing is drawn: its clusters may be listed nowhere.
	if (args.counts.at[0].overflow == 0u && args.shared_instances.at[index] != NOT_SHARED)
	{
		InstanceRecord scene_instance = args.scene_instances.at[index];
		Placement placement = placementOf(scene_instance, frame_view);
		placed_instance.row0 = vec4(placement.row0, placement.translation.x);
		placed_instance.row1 = vec4(placement.row1, placement.translation.y);
		placed_instance.row2 = vec4(placement.row2, placement.translation.z);
		placed_instance.index_and_mask = 0xffu << 24 | index;
		placed_instance.structure = packUint2x32(args.mesh_structures.at[scene_instance.mesh]);
	}
	args.instances.at[1u + index] = placed_instance;
}

void placeOfScene(ClusterWork work, uint index)
{
	uint structure = work.instances.at[index].structure;
	uint flags = HAS_MIRRORED_INSTANCES && args.scene_instances.at[index].mirrored != 0u ? RAY_INSTANCE_TURNED : 0u;
	uint64_t address = 0ul;
	if (structure != NO_STRUCTURE)
	{
		address = work.structure_addresses.at[structure].bytes;
		atomicAdd(unit_sum, (work.structure_bytes.at[structure] + 15u) / 16u);
	}
	args.instances.at[index] = instanceOf(address, flags);
}

void main()
{
	if (!BUILDS_CLUSTERS)
	{
		if (gl_GlobalInvocationID.x == 0u)
		{
			args.instances.at[0] = instanceOf(args.geometry, 0u);
			args.instances.at[0].index_and_mask |= OWN_STRUCTURE;
		}
		for (uint i = gl_GlobalInvocationID.x; SHARES_STRUCTURES && i < args.scene_instance_count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x)
			placeShared(i);
		return;
	}
	if (gl_LocalInvocationIndex == 0u)
		unit_sum = 0u;
	barrier();
	ClusterWork work = args.work.at[0];
	uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
	for (uint i = gl_GlobalInvocationID.x; i < work.scene_instances; i += stride)
		placeOfScene(work, i);
	barrier();
	if (gl_LocalInvocationIndex == 0u && unit_sum > 0u)
		atomicAdd(work.counts.at[0].structure_units, unit_sum);
}
