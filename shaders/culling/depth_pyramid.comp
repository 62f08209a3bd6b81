// depth_pyramid: the farthest depth of every square of pixels, for occlusion culling: this frame's second phase, and the next
// frame's first.
//
//   in   visibility_buffer   uint64[]   from raster_micro
//   out  depth_pyramid       float[]    PYRAMID_LEVELS levels (shared/history.h)
//
// One workgroup makes all levels of a square of 64 x 64 pixels; as many rows of threads as the device likes, each thread takes texels of its
// column.
// Host: src/pipeline/culling/depth_pyramid.cpp   Test: tests/gpu/occlusion_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
// Before every include: glslang takes a workgroup size that is used before it is declared for 1.
layout(local_size_x = 16, local_size_y_id = 0) in;
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "culling/depth_pyramid.h"

const uint TILE_TEXELS = 16u;  // sides of level 0

layout(push_constant, scalar) uniform Args { DepthPyramidArgs args; };

shared float farthest[2][TILE_TEXELS][TILE_TEXELS];  // even and odd levels

// Pixels beyond the picture hide nothing and are not asked for: they do not count.
float texelDepth(uvec2 texel, View view)
{
	// The upper halves of the 64-bit words.
	uintRef words = uintRef(args.visibility);
	uvec2 low = texel * PYRAMID_TEXEL_PX;
	uvec2 high = min(low + PYRAMID_TEXEL_PX, uvec2(view.width_px, view.height_px));
	float depth = 1e38;
	for (uint y = low.y; y < high.y; ++y)
		for (uint x = low.x; x < high.x; ++x)
			depth = min(depth, uintBitsToFloat(words.at[2u * (y * view.width_px + x) + 1u]));
	return depth;
}

void store(uvec2 texel, uint level, float depth, View view)
{
	uvec2 size = uvec2(pyramidSide(view.width_px, level), pyramidSide(view.height_px, level));
	if (all(lessThan(texel, size)))
		frame_history.pyramid.at[pyramidFirst(view.width_px, view.height_px, level) + texel.y * size.x + texel.x] = depth;
}

void makeFirstLevel(View view)
{
	for (uint row = gl_LocalInvocationID.y; row < TILE_TEXELS; row += gl_WorkGroupSize.y)
	{
		uvec2 texel = uvec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y * TILE_TEXELS + row);
		float depth = texelDepth(texel, view);
		farthest[0][row][gl_LocalInvocationID.x] = depth;
		store(texel, 0u, depth, view);
	}
}

// From the level before, which lies in the other half.
void makeLevel(uint level, View view)
{
	uint side = TILE_TEXELS >> level, from = (level + 1u) & 1u;
	for (uint row = gl_LocalInvocationID.y; row < side && gl_LocalInvocationID.x < side; row += gl_WorkGroupSize.y)
	{
		uint x = 2u * gl_LocalInvocationID.x, y = 2u * row;
		float depth = min(min(farthest[from][y][x], farthest[from][y][x + 1u]), min(farthest[from][y + 1u][x], farthest[from][y + 1u][x + 1u]));
		farthest[level & 1u][row][gl_LocalInvocationID.x] = depth;
		store(gl_WorkGroupID.xy * side + uvec2(gl_LocalInvocationID.x, row), level, depth, view);
	}
}

void main()
{
	View view = frame_view;
	makeFirstLevel(view);
	for (uint level = 1u; level < PYRAMID_LEVELS; ++level)
	{
		barrier();
		makeLevel(level, view);
	}
}
