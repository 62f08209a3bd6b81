// draw_indexed: pass on the micro-vertices that evaluate_vertices wrote.
//
//   in   micro_vertices   vec4[]
//   out  visibility       depth and payload attachments, by draw_indexed.frag
//
// Host: src/pipeline/raster/draw_indexed.cpp   Test: tests/gpu/raster_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raster/draw_indexed.h"
#include "lib/micro_vertices.glsl"

layout(push_constant, scalar) uniform Args { DrawIndexedArgs args; };
out gl_PerVertex { vec4 gl_Position; };

void main() { gl_Position = clipOfKept(args.vertices.at[gl_VertexIndex]); }
