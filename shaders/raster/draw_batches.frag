// draw_batches: write the payload of the nearest micro-triangle. Test: tests/gpu/raster_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_mesh_shader : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raster/draw_batches.h"
#include "lib/sides.glsl"

layout(push_constant, scalar) uniform Args { DrawBatchesArgs args; };
layout(location = 0) perprimitiveEXT flat in uint payload;
layout(location = 0) out uint visible;

void main()
{
	if (isHiddenSide(args.inputs, payload, gl_FrontFacing))
		discard;
	visible = payload;
}
