// measure_hidden: how far is every instance from being seen, and was any seen that had grown coarser because it was hidden?
//
//   in   mesh_bounds             DisplacedBounds[]
//   in   visibility_buffer       uint64[]           of this frame: what hides
//   in   depth_pyramid           float[]            the same, coarser
//   in   hidden_instances        HiddenInstance[]   as this frame was tessellated with
//   out  hidden_instances_next   HiddenInstance[]   for the next frame, or for this one drawn again
//   out  counts                  hidden_instances, shown_instances
//
// The displaced bounds of an instance are a box on screen. Looked for is the nearest pixel that does not hide all of the box. One workgroup takes one
// instance at a time, one lane a square of SQUARE_TEXELS x SQUARE_TEXELS texels of the pyramid's finest level. Squares that do not hide all of it, and
// are nearer than the nearest pixel so far, are looked at by texels, and these by pixels.
// Where this says of every instance that has grown that it cannot be seen, the picture is that of a frame in which none has (docs/raytracing.md).
// Host: src/pipeline/culling/measure_hidden.cpp   Test: tests/gpu/raytracing/hidden_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x_id = 0) in;
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "culling/measure_hidden.h"
#include "lib/occlusion.glsl"

layout(push_constant, scalar) uniform Args { MeasureHiddenArgs args; };

const uint SQUARE_LEVEL = 2u;  // of the pyramid
const uint SQUARE_TEXELS = 1u << SQUARE_LEVEL;

shared uint nearest_gap;  // bits of the least distance to what does not hide, px; floats above 0 are ordered as their bits

float depthSeen(uvec2 texel, uint level)
{
	uint first = pyramidFirst(frame_view.width_px, frame_view.height_px, level);
	return frame_history.pyramid.at[first + texel.y * pyramidSide(frame_view.width_px, level) + texel.x];
}

// The upper half of the pixel's word.
float depthOf(uvec2 pixel) { return uintBitsToFloat(uintRef(args.visibility).at[2u * (pixel.y * frame_view.width_px + pixel.x) + 1u]); }

// How far a square of pixels lies beside the box on screen, the larger of both axes; 0 where they meet.
float gapTo(uvec2 square, uint side_px, ScreenBox box)
{
	float side = float(side_px);
	vec2 low = vec2(square) * side;
	vec2 gap = max(low - box.high_px, box.low_px - low - side);
	return max(max(gap.x, gap.y), 0.0);
}

// The least distance, if it is below `least`, of the pixels of a texel that do not hide the box.
float leastOfPixels(uvec2 texel, ScreenBox box, float least)
{
	uvec2 end = min((texel + 1u) * PYRAMID_TEXEL_PX, uvec2(frame_view.width_px, frame_view.height_px));
	for (uint y = texel.y * PYRAMID_TEXEL_PX; y < end.y; ++y)
		for (uint x = texel.x * PYRAMID_TEXEL_PX; x < end.x; ++x)
		{
			float gap = gapTo(uvec2(x, y), 1u, box);
			if (gap < least && !isBehind(box, depthOf(uvec2(x, y))))
				least = gap;
		}
	return least;
}

// The same of the pixels of a square of texels.
float leastWithin(uvec2 square, ScreenBox box, float least)
{
	uvec2 end = min((square + 1u) * SQUARE_TEXELS, uvec2(pyramidSide(frame_view.width_px, 0u), pyramidSide(frame_view.height_px, 0u)));
	for (uint y = square.y * SQUARE_TEXELS; y < end.y; ++y)
		for (uint x = square.x * SQUARE_TEXELS; x < end.x; ++x)
			if (gapTo(uvec2(x, y), PYRAMID_TEXEL_PX, box) < least && !isBehind(box, depthSeen(uvec2(x, y), 0u)))
				least = leastOfPixels(uvec2(x, y), box, least);
	return least;
}

// Into nearest_gap. All lanes together.
void measure(ScreenBox box, float farthest)
{
	vec2 last_px = vec2(frame_view.width_px, frame_view.height_px) - 1.0;
	uint side = PYRAMID_TEXEL_PX << SQUARE_LEVEL;
	uvec2 first = uvec2(clamp(box.low_px - farthest, vec2(0.0), last_px)) / side;
	uvec2 count = uvec2(clamp(box.high_px + farthest, vec2(0.0), last_px)) / side - first + 1u;
	float least = farthest;
	for (uint i = gl_LocalInvocationIndex; i < count.x * count.y && least > 0.0; i += gl_WorkGroupSize.x)
	{
		uvec2 square = first + uvec2(i % count.x, i / count.x);
		if (gapTo(square, side, box) >= least || isBehind(box, depthSeen(square, SQUARE_LEVEL)))
			continue;
		least = leastWithin(square, box, least);
		least = min(least, uintBitsToFloat(atomicMin(nearest_gap, floatBitsToUint(least))));
	}
}

// How far the box lies from the sides of the picture, px: what is beyond them is unknown. Below 0: part of it is outside.
float gapToSides(ScreenBox box)
{
	vec2 gap = min(box.low_px, vec2(frame_view.width_px, frame_view.height_px) - box.high_px);
	return min(gap.x, gap.y);
}

// What stands for half a turn out of view: the distance to the eye; in parallel views half the view's height.
float wholeWorld(ViewBox box)
{
	if (frame_view.distance_weight == 0.0)
		return 1.0 / (frame_view.focal_y * frame_view.unit);
	return max(length(max(max(box.low, -box.high), vec3(0.0))), frame_view.near) / frame_view.unit;
}

void finish(uint index, ViewBox box, bool can_touch_picture, bool has_place, float sides_px)
{
	HiddenInstance last = args.hidden_instances.at[index];
	float gap = has_place ? uintBitsToFloat(nearest_gap) : 0.0;
	float margin = can_touch_picture ? min(gap, sides_px) : 0.0;
	args.hidden_instances_next.at[index] = nextHidden(last, margin / float(frame_view.height_px), wholeWorld(box));
	if (last.distance_world > 0.0)
	{
		atomicAdd(args.counts.at[0].hidden_instances, 1u);
		if (can_touch_picture && gap <= 0.0)
			atomicAdd(args.counts.at[0].shown_instances, 1u);
	}
}

void main()
{
	// Nothing was drawn: nobody asks.
	if (args.counts.at[0].overflow != 0u)
		return;
	View view = frame_view;
	float farthest = HIDDEN_FARTHEST * float(view.height_px);
	for (uint index = gl_WorkGroupID.x; index < args.instance_count; index += gl_NumWorkGroups.x)
	{
		InstanceRecord instance = args.instances.at[index];
		DisplacedBounds bounds = args.mesh_bounds.at[instance.mesh];
		Box box = displacedBox(bounds, view.displacement_scale, view.displacement_offset);
		bool can_touch_picture = boxMayBeVisible(box, placementOf(instance, view), view);
		ViewBox seen = viewBox(bounds, instance, view);
		bool has_place = isBeforeEye(seen, view);
		if (gl_LocalInvocationIndex == 0u)
			nearest_gap = floatBitsToUint(farthest);
		barrier();
		ScreenBox screen = onScreen(seen, view);
		if (can_touch_picture && has_place)
			measure(screen, farthest);
		barrier();
		if (gl_LocalInvocationIndex == 0u)
			finish(index, seen, can_touch_picture, has_place, gapToSides(screen));
		barrier();
	}
}
