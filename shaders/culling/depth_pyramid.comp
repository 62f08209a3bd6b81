// depth_pyramid: the farthest depth of every square of pixels, for occlusion culling: this frame's second phase, and the next
// frame's first.
//
//   in   visibility_buffer   uint64[]   from raster_micro
//   out  depth_pyramid       float[]    PYRAMID_LEVELS levels (shared/history.h)
//
// One workgroup makes all levels of a square of 64 x 64 pixels: each thread a texel of level 0, then fewer.
// Host: src/pipeline/culling/depth_pyramid.cpp   Test: tests/gpu/occlusion_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "culling/depth_pyramid.h"

const uint TILE_TEXELS = 16u;  // sides of level 0

layout(local_size_x = TILE_TEXELS, local_size_y = TILE_TEXELS) in;
layout(push_constant, scalar) uniform Args { DepthPyramidArgs args; };

shared float farthest[TILE_TEXELS][TILE_TEXELS];

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

void main()
{
	View view = frame_view;
	uvec2 local = gl_LocalInvocationID.xy;
	float depth = texelDepth(gl_GlobalInvocationID.xy, view);
	store(gl_GlobalInvocationID.xy, 0u, depth, view);
	for (uint level = 1u; level < PYRAMID_LEVELS; ++level)
	{
		farthest[local.y][local.x] = depth;
		barrier();
		uint side = TILE_TEXELS >> level;
		uvec2 from = 2u * local;
		if (all(lessThan(local, uvec2(side))))
		{
			depth = min(min(farthest[from.y][from.x], farthest[from.y][from.x + 1u]), min(farthest[from.y + 1u][from.x], farthest[from.y + 1u][from.x + 1u]));
			store(gl_WorkGroupID.xy * side + local, level, depth, view);
		}
		barrier();
	}
}
