// view.h: the camera of a frame and the placement of an instance relative to it, in floats that every device rounds alike.
// All lengths here are world units times one power of two (`unit`), so that squares neither overflow nor become denormal.
// Source: DESIGN.md, section 5.
#ifndef TESSERA_SHARED_VIEW_H
#define TESSERA_SHARED_VIEW_H
#include "shared/lang.h"

SHARED_BEGIN

struct View
{
	vec3 eye_high;  // world position of the eye = eye_high + eye_low
	vec3 eye_low;
	vec3 right;  // rows of the world to view rotation
	vec3 up;
	vec3 forward;
	float unit;                  // the power of two
	float inverse_unit_squared;  // 1 / unit^2, exact
	float focal_x;               // clip.x = focal_x * view.x
	float focal_y;
	float depth_slope;  // clip.z = depth_slope * depth + depth_offset   (perspective: 0, near; reverse z, infinite far)
	float depth_offset;
	float w_slope;  // clip.w = w_slope * depth + w_offset           (perspective: 1, 0; orthographic: 0, 1)
	float w_offset;
	float near;                       // scaled
	float distance_weight;            // perspective 1, orthographic 0
	float distance_floor_squared;     // near squared; orthographic: one world unit squared
	float rate_over_focal_squared;    // s^2 of the granted rate; +infinity: every factor is 1
	float sample_over_focal_squared;  // the same for mip levels; 0 when the rate is 0
	float displacement_scale;
	float displacement_offset;  // mesh units, added before the scale
	uint width_px;
	uint height_px;
	// What follows is derived from the above, so that no thread does it again.
	float width_subpixels;  // width_px * SCREEN_SUBPIXELS
	float height_subpixels;
	// A pixel's ray, pixel = (x, y) with centres at .5, y down: where it meets the plane one unit ahead is, beside the view's axis,
	// ray_first + x ray_x + y ray_y.
	vec3 ray_first;
	vec3 ray_x;
	vec3 ray_y;
	// Not 0 where a picture is drawn from another camera than it was tessellated for:
	vec3 draw_eye;     // that camera, relative to the eye, scaled
	vec3 draw_offset;  // the way back along right, up and forward
	// How far outside the view that is tessellated for a point lies, for edges that only rays meet (edge_factor.h). Beyond the right and the left
	// side: +-dot(side_x, p) - side_x_ahead * dot(ahead, p) - side_x_from; so with y; behind the eye: -dot(ahead, p) - behind_from.
	vec3 side_x;
	vec3 side_y;
	vec3 ahead;
	float side_x_ahead;
	float side_y_ahead;
	float side_x_from;
	float side_y_from;
	float behind_from;
	float unseen_growth;  // X^2 of --ray-falloff; orthographic: over half the view's height squared. 0: nothing falls off
};
SHARED_LAYOUT(View, 256, unseen_growth, 252)

#define SCREEN_SUBPIXELS 256  // positions on screen are rounded to 1/256 pixel

// Placement of one mesh in the world.
struct InstanceRecord
{
	vec3 row0;  // rows of the linear part, mesh to world
	vec3 row1;
	vec3 row2;
	vec3 translation_high;  // world translation = high + low
	vec3 translation_low;
	float inverse_scale_squared;  // 1 / (world units per mesh unit)^2, for mip levels
	uint mesh;
	uint mirrored;  // 1: negative determinant, triangles turn over
	// What its clusters' ranges of vertices and triangles are moved by where each has a place of its own in a frame's buffers (modulo 2^32).
	uint vertex_place;
	uint triangle_place;
	// How far a base triangle reaches from any of its points, world units: the triangle itself; what displacement at scale 1 adds; what one mesh unit
	// of a displacement offset adds at scale 1.
	vec3 reach;
};
SHARED_LAYOUT(InstanceRecord, 92, reach, 80)

// Mesh to camera-relative, scaled: the translation is the difference of two-float sums, exact where it matters (near the eye).
struct Placement
{
	vec3 row0;
	vec3 row1;
	vec3 row2;
	vec3 translation;
	float inverse_scale_squared;  // (mesh units per scaled world unit)^2
	float triangle_reach;         // how far a base triangle reaches, displaced, from any of its points; 0 where nothing asks
	float hidden_squared;         // what its being hidden adds to the squared distance that decides segments (placementForEdges); else 0
};

SHARED_FN precise float cameraRelative(float high, float low, float eye_high, float eye_low, float unit)
{
	precise float difference_high = high - eye_high;
	precise float difference_low = low - eye_low;
	precise float difference = difference_high + difference_low;
	precise float scaled = difference * unit;
	return scaled;
}

SHARED_FN precise vec3 scaledRow(vec3 row, float unit)
{
	precise vec3 scaled;
	scaled.x = row.x * unit;
	scaled.y = row.y * unit;
	scaled.z = row.z * unit;
	return scaled;
}

SHARED_FN precise float triangleReach(InstanceRecord instance, View view)
{
	precise float by_offset = instance.reach.z * max(view.displacement_offset, -view.displacement_offset);
	precise float at_scale_one = instance.reach.y + by_offset;
	precise float displaced = at_scale_one * max(view.displacement_scale, -view.displacement_scale);
	precise float reach = instance.reach.x + displaced;
	precise float scaled = reach * view.unit;
	return scaled;
}

SHARED_FN Placement placementOf(InstanceRecord instance, View view)
{
	Placement placement;
	placement.row0 = scaledRow(instance.row0, view.unit);
	placement.row1 = scaledRow(instance.row1, view.unit);
	placement.row2 = scaledRow(instance.row2, view.unit);
	placement.translation.x = cameraRelative(instance.translation_high.x, instance.translation_low.x, view.eye_high.x, view.eye_low.x, view.unit);
	placement.translation.y = cameraRelative(instance.translation_high.y, instance.translation_low.y, view.eye_high.y, view.eye_low.y, view.unit);
	placement.translation.z = cameraRelative(instance.translation_high.z, instance.translation_low.z, view.eye_high.z, view.eye_low.z, view.unit);
	precise float inverse_scale_squared = instance.inverse_scale_squared * view.inverse_unit_squared;
	placement.inverse_scale_squared = inverse_scale_squared;
	placement.hidden_squared = 0.0f;
	placement.triangle_reach = 0.0f;
	if (HAS_RAY_FALLOFF)
		placement.triangle_reach = triangleReach(instance, view);
	return placement;
}

SHARED_FN precise float affineRow(vec3 row, vec3 p, float offset)
{
	precise float xy = row.x * p.x + row.y * p.y;
	precise float z = row.z * p.z + offset;
	precise float sum = xy + z;
	return sum;
}

// A mesh-space point relative to the eye, scaled.
SHARED_FN precise vec3 placed(Placement placement, vec3 p)
{
	precise vec3 result;
	result.x = affineRow(placement.row0, p, placement.translation.x);
	result.y = affineRow(placement.row1, p, placement.translation.y);
	result.z = affineRow(placement.row2, p, placement.translation.z);
	return result;
}

// Squared distance that decides a rate at a camera-relative point; never below the near distance.
SHARED_FN precise float rateDistanceSquared(vec3 relative, View view)
{
	precise float xy = relative.x * relative.x + relative.y * relative.y;
	precise float squared = xy + relative.z * relative.z;
	precise float weighted = squared * view.distance_weight;
	return max(weighted, view.distance_floor_squared);
}

// Depth of a camera-relative point along the view.
SHARED_FN precise float viewDepth(vec3 relative, View view)
{
	return affineRow(view.forward, relative, view.draw_offset.z);
}

// Clip coordinates from x and y and the depth along the view: reverse z, nearer is larger.
SHARED_FN precise vec4 clipAt(vec2 xy, float depth, View view)
{
	precise vec4 clip;
	clip.x = xy.x;
	clip.y = xy.y;
	clip.z = depth * view.depth_slope + view.depth_offset;
	clip.w = depth * view.w_slope + view.w_offset;
	return clip;
}

// Clip coordinates of a camera-relative point.
SHARED_FN precise vec4 clipPosition(vec3 relative, View view)
{
	precise float x = affineRow(view.right, relative, view.draw_offset.x);
	precise float y = affineRow(view.up, relative, view.draw_offset.y);
	precise vec2 xy;
	xy.x = x * view.focal_x;
	xy.y = -(y * view.focal_y);
	return clipAt(xy, viewDepth(relative, view), view);
}

SHARED_END

#endif
