// place_instances: say where the structures lie that rays are traced through.
//
//   out  ray_instances   RayInstance[]   0: the frame's micro-triangles, which are relative to the eye already
//
// Host: src/pipeline/raytracing/place_instances.cpp   Test: tests/gpu/raytracing/primary_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raytracing/place_instances.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Args { PlaceInstancesArgs args; };

void main()
{
	RayInstance geometry;
	geometry.row0 = vec4(1.0, 0.0, 0.0, 0.0);
	geometry.row1 = vec4(0.0, 1.0, 0.0, 0.0);
	geometry.row2 = vec4(0.0, 0.0, 1.0, 0.0);
	geometry.index_and_mask = 0xffu << 24;
	geometry.offset_and_flags = 0u;
	geometry.structure = args.geometry;
	args.instances.at[0] = geometry;
}
