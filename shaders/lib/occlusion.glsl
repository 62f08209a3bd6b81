// Whether a box lies behind everything that a depth pyramid has seen (contract C3). A box that leaves the picture, comes before
// the near plane or spans more than the coarsest level can answer for is not hidden.
// Source: Greene, Kass and Miller, Hierarchical Z-Buffer Visibility (1993); two phases: Haar and Aaltonen, GPU-Driven
// Rendering Pipelines (2015).
#ifndef TESSERA_LIB_OCCLUSION
#define TESSERA_LIB_OCCLUSION
#include "lib/frame_data.glsl"
#include "shared/bounds.h"
#include "shared/surface.h"

const uint OCCLUSION_TEXELS = 3u;  // along a side of the box on screen that are read

vec3 inView(vec3 vector, View view) { return vec3(dot(view.right, vector), dot(view.up, vector), dot(view.forward, vector)); }

// The least of three texels a side; of fewer, some twice: that is cheaper than loops that end at different times.
float farthestSeen(floatRef pyramid, uvec2 first, uvec2 last, uint level, View view)
{
	uint width = pyramidSide(view.width_px, level);
	uvec2 low = first >> level, high = last >> level, middle = min(low + 1u, high);
	uvec3 rows = pyramidFirst(view.width_px, view.height_px, level) + uvec3(low.y, middle.y, high.y) * width;
	float farthest = 1e38;
	for (uint y = 0u; y < OCCLUSION_TEXELS; ++y)
	{
		float left = pyramid.at[rows[y] + low.x], centre = pyramid.at[rows[y] + middle.x], right = pyramid.at[rows[y] + high.x];
		farthest = min(farthest, min(left, min(centre, right)));
	}
	return farthest;
}

// A box along the axes of the view, relative to its eye and scaled as everything placed in it.
struct ViewBox
{
	vec3 low;
	vec3 high;
};

// The pixels that a box can touch, and the depth of its nearest point.
struct ScreenBox
{
	vec2 low_px;
	vec2 high_px;
	float nearest;
};

// False where it comes before the near plane.
bool isBeforeEye(ViewBox box, View view) { return box.low.z > view.near; }

// Of a box before the eye.
ScreenBox onScreen(ViewBox box, View view)
{
	vec3 low = box.low, high = box.high;
	float near_inverse = 1.0 / (low.z * view.w_slope + view.w_offset), far_inverse = 1.0 / (high.z * view.w_slope + view.w_offset);
	vec2 focal = vec2(view.focal_x, view.focal_y), size = vec2(view.width_px, view.height_px);
	vec2 ndc_low = min(low.xy * near_inverse, low.xy * far_inverse) * focal;
	vec2 ndc_high = max(high.xy * near_inverse, high.xy * far_inverse) * focal;
	// Rows run downwards. A pixel more on every side: positions snap, and samples lie at centres.
	ScreenBox screen;
	screen.low_px = (vec2(ndc_low.x, -ndc_high.y) * 0.5 + 0.5) * size - 1.0;
	screen.high_px = (vec2(ndc_high.x, -ndc_low.y) * 0.5 + 0.5) * size + 1.0;
	screen.nearest = (low.z * view.depth_slope + view.depth_offset) * near_inverse;
	return screen;
}

// Whether all of a box lies behind what hides this deep.
bool isBehind(ScreenBox box, float depth) { return box.nearest + abs(box.nearest) * 1e-5 < depth; }

bool boxIsHidden(ViewBox box, View view, floatRef pyramid)
{
	if (!isBeforeEye(box, view))
		return false;
	ScreenBox screen = onScreen(box, view);
	vec2 size = vec2(view.width_px, view.height_px);
	if (!(all(greaterThanEqual(screen.low_px, vec2(0.0))) && all(lessThan(screen.high_px, size))))
		return false;
	uvec2 first = uvec2(screen.low_px) / PYRAMID_TEXEL_PX, last = uvec2(screen.high_px) / PYRAMID_TEXEL_PX;
	uint level = 0u;
	while (level < PYRAMID_LEVELS && max((last.x >> level) - (first.x >> level), (last.y >> level) - (first.y >> level)) >= OCCLUSION_TEXELS)
		++level;
	if (level == PYRAMID_LEVELS)
		return false;
	return isBehind(screen, farthestSeen(pyramid, first, last, level, view));
}

// What three half axes reach along the axes of the view.
vec3 reachInView(vec3 axis0, vec3 axis1, vec3 axis2, View view)
{
	return abs(inView(axis0, view)) + abs(inView(axis1, view)) + abs(inView(axis2, view));
}

// Around everything that displaced bounds hold.
ViewBox viewBox(DisplacedBounds bounds, InstanceRecord instance, View view)
{
	Placement placement = placementOf(instance, view);
	Box box = displacedBox(bounds, view.displacement_scale, view.displacement_offset);
	vec3 middle = (box.low + box.high) * 0.5, half_size = box.high - middle;
	vec3 axis0 = vec3(placement.row0.x, placement.row1.x, placement.row2.x) * half_size.x;
	vec3 axis1 = vec3(placement.row0.y, placement.row1.y, placement.row2.y) * half_size.y;
	vec3 axis2 = vec3(placement.row0.z, placement.row1.z, placement.row2.z) * half_size.z;
	vec3 centre = inView(placed(placement, middle), view);
	vec3 reach = reachInView(axis0, axis1, axis2, view);
	reach += (abs(centre) + reach) * 1e-5;
	return ViewBox(centre - reach, centre + reach);
}

bool clusterIsHidden(DisplacedBounds bounds, InstanceRecord instance, View view, floatRef pyramid)
{
	return boxIsHidden(viewBox(bounds, instance, view), view, pyramid);
}

// The displaced piece with undisplaced corners p, q, r, mesh units.
bool pieceIsHidden(vec3 p, vec3 q, vec3 r, DisplacedBounds bounds, InstanceRecord instance, View view, floatRef pyramid)
{
	Placement placement = placementOf(instance, view);
	PlacedReach reach = placedReach(bounds, placement, view);
	vec3 a = inView(placed(placement, p), view), b = inView(placed(placement, q), view), c = inView(placed(placement, r), view);
	vec3 middle = inView(reach.centre, view);
	// The slack is along an axis of the world: along one of the view it is up to root 3 times that.
	vec3 extent = reachInView(reach.axis0, reach.axis1, reach.axis2, view) + reach.slack * 1.75;
	// Of what is added up, not of the sum: displacement may bring near what lies far.
	extent += (max(abs(a), max(abs(b), abs(c))) + abs(middle) + extent) * 1e-5;
	return boxIsHidden(ViewBox(min(a, min(b, c)) + middle - extent, max(a, max(b, c)) + middle + extent), view, pyramid);
}

bool wasHidden(DisplacedBounds bounds, InstanceRecord instance)
{
	return frame_history.has_last != 0u && clusterIsHidden(bounds, instance, frame_history.last_view, frame_history.last_pyramid);
}

#endif
