// keep_visibility: copy what every pixel sees before shade empties it, in one form for every raster path.
//
//   in   visibility_depth, visibility_payload   from drawing passes
//   in   visibility_buffer                      from raster_micro
//   out  kept_visibility   uint64[]   per pixel, depth << 32 | payload; 0 is background
//
// Only in frames whose visibility is wanted as such. One thread per pixel.
// Host: src/pipeline/raster/keep_visibility.cpp   Test: tests/gpu/verify_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raster/keep_visibility.h"
#include "lib/visibility_buffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Args { KeepVisibilityArgs args; };
layout(set = 0, binding = 1) uniform utexture2D visibility_payload;
layout(set = 0, binding = 2) uniform texture2D visibility_depth;

uint64_t attachedWord(ivec2 place)
{
	float depth = texelFetch(visibility_depth, place, 0).x;
	if (depth == 0.0)
		return 0ul;
	return uint64_t(floatBitsToUint(depth)) << 32 | uint64_t(texelFetch(visibility_payload, place, 0).x);
}

void main()
{
	uvec2 place = gl_GlobalInvocationID.xy;
	if (place.x >= frame_view.width_px || place.y >= frame_view.height_px)
		return;
	uint index = place.y * frame_view.width_px + place.x;
	VisibilityRef kept = VisibilityRef(args.kept);
	if (READS_BUFFER)
		kept.at[index] = VisibilityRef(args.visibility).at[index];
	else
		kept.at[index] = attachedWord(ivec2(place));
}
