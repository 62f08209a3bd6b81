// Whether a box lies behind everything that a depth pyramid has seen (contract C3). A box that leaves the picture, comes before
// the near plane or spans more than the coarsest level can answer for is not hidden.
// Source: Greene, Kass and Miller, Hierarchical Z-Buffer Visibility (1993); two phases: Haar and Aaltonen, GPU-Driven
// Rendering Pipelines (2015).
#ifndef TESSERA_LIB_OCCLUSION
#define TESSERA_LIB_OCCLUSION
#include "lib/frame_data.glsl"
#include "shared/bounds.h"
#include "shared/surface.h"

const uint OCCLUSION_TEXELS = 3u;  // most texels along a side of the box on screen that are read

vec3 inView(vec3 vector, View view) { return vec3(dot(view.right, vector), dot(view.up, vector), dot(view.forward, vector)); }

float farthestSeen(floatRef pyramid, uvec2 low, uvec2 high, uint level, View view)
{
	uint width = pyramidSide(view.width_px, level);
	uint first = pyramidFirst(view.width_px, view.height_px, level);
	float farthest = 1e38;
	for (uint y = low.y >> level; y <= high.y >> level; ++y)
		for (uint x = low.x >> level; x <= high.x >> level; ++x)
			farthest = min(farthest, pyramid.at[first + y * width + x]);
	return farthest;
}

// Box: centre and half axes, relative to the view's eye and scaled as everything placed in that view.
bool boxIsHidden(vec3 centre, vec3 axis0, vec3 axis1, vec3 axis2, View view, floatRef pyramid)
{
	vec3 middle = inView(centre, view);
	vec3 reach = abs(inView(axis0, view)) + abs(inView(axis1, view)) + abs(inView(axis2, view));
	reach += (abs(middle) + reach) * 1e-5;
	vec3 low = middle - reach, high = middle + reach;
	if (!(low.z > view.near))
		return false;
	float near_w = low.z * view.w_slope + view.w_offset, far_w = high.z * view.w_slope + view.w_offset;
	vec2 focal = vec2(view.focal_x, view.focal_y), size = vec2(view.width_px, view.height_px);
	vec2 ndc_low = min(low.xy / near_w, low.xy / far_w) * focal;
	vec2 ndc_high = max(high.xy / near_w, high.xy / far_w) * focal;
	// Rows run downwards. A pixel more on every side: positions snap, and samples lie at centres.
	vec2 px_low = (vec2(ndc_low.x, -ndc_high.y) * 0.5 + 0.5) * size - 1.0;
	vec2 px_high = (vec2(ndc_high.x, -ndc_low.y) * 0.5 + 0.5) * size + 1.0;
	if (!(all(greaterThanEqual(px_low, vec2(0.0))) && all(lessThan(px_high, size))))
		return false;
	uvec2 first = uvec2(px_low) / PYRAMID_TEXEL_PX, last = uvec2(px_high) / PYRAMID_TEXEL_PX;
	uint level = 0u;
	while (level < PYRAMID_LEVELS && max((last.x >> level) - (first.x >> level), (last.y >> level) - (first.y >> level)) >= OCCLUSION_TEXELS)
		++level;
	if (level == PYRAMID_LEVELS)
		return false;
	float nearest = (low.z * view.depth_slope + view.depth_offset) / near_w;
	return nearest + abs(nearest) * 1e-5 < farthestSeen(pyramid, first, last, level, view);
}

bool clusterIsHidden(DisplacedBounds bounds, InstanceRecord instance, View view, floatRef pyramid)
{
	Placement placement = placementOf(instance, view);
	Box box = displacedBox(bounds, view.displacement_scale);
	vec3 middle = (box.low + box.high) * 0.5, half_size = box.high - middle;
	vec3 axis0 = vec3(placement.row0.x, placement.row1.x, placement.row2.x) * half_size.x;
	vec3 axis1 = vec3(placement.row0.y, placement.row1.y, placement.row2.y) * half_size.y;
	vec3 axis2 = vec3(placement.row0.z, placement.row1.z, placement.row2.z) * half_size.z;
	return boxIsHidden(placed(placement, middle), axis0, axis1, axis2, view, pyramid);
}

// The displaced piece with undisplaced corners p, q, r, mesh units.
bool pieceIsHidden(vec3 p, vec3 q, vec3 r, DisplacedBounds bounds, InstanceRecord instance, View view, floatRef pyramid)
{
	Placement placement = placementOf(instance, view);
	PieceBox box = pieceBox(placed(placement, p), placed(placement, q), placed(placement, r), placedReach(bounds, placement, view));
	return boxIsHidden(box.centre, vec3(box.half_size.x, 0.0, 0.0), vec3(0.0, box.half_size.y, 0.0), vec3(0.0, 0.0, box.half_size.z), view, pyramid);
}

bool wasHidden(DisplacedBounds bounds, InstanceRecord instance)
{
	return frame_history.has_last != 0u && clusterIsHidden(bounds, instance, frame_history.last_view, frame_history.last_pyramid);
}

#endif
