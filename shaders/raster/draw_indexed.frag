// draw_indexed: write the payload of the nearest micro-triangle. Test: tests/gpu/raster_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raster/draw_indexed.h"
#include "lib/sides.glsl"

layout(push_constant, scalar) uniform Args { DrawIndexedArgs args; };
layout(location = 0) out uint visible;

void main()
{
	uint payload = args.expanded_triangles.at[args.first_payload + gl_PrimitiveID];
	if (isHiddenSide(args.inputs, payload, gl_FrontFacing))
		discard;
	visible = payload;
}
