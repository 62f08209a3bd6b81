// ray_sharing.h: which instances may be traced through a structure of their mesh in its own space, which all instances of the mesh share, instead of
// through triangles that are placed and expanded for the frame. The driver then moves rays into that space, which rounds; an instance shares only
// where that stays far below a pixel and below what light's rays start off the surface. A device that rounds differently may choose differently: both
// ways lead to the same picture. Derived in docs/numerics.md, "Rays through shared structures".
#ifndef TESSERA_SHARED_RAY_SHARING_H
#define TESSERA_SHARED_RAY_SHARING_H
#include "shared/bounds.h"

SHARED_BEGIN

// Entry of shared_instances where an instance does not share. Else: where its clusters begin in shared_clusters.
#define NOT_SHARED 0xffffffffu
// What hits of the frame's own structure are told in place of an instance. Custom indices have 24 bits.
#define OWN_STRUCTURE 0xffffffu

// What an instance's triangles, as rays through its mesh's structure meet them, are off by from those that are placed for the frame: at most
// SHARING_ROUNDING x (distance from the eye + reach from the mesh's origin), where the axes are nearly at right angles.
#define SHARING_ROUNDING (6.0f / 16777216.0f)
#define SHARING_MOST_PX (1.0f / 512.0f)
// The same for light's rays, which start more_offset = LIGHT_SHARING_OFFSET farther off the surface for it (lib/ray_origin.glsl).
#define SHARING_MOST_REACH 4.0f
#define LIGHT_SHARING_OFFSET (128.0f / 16777216.0f)

// Of a frame, from the host (scene/ray_sharing.h).
struct RaySharing
{
	float most_reach_squared;  // perspective: (reach from the mesh's origin over the nearest distance)^2, at most
	float most_span_squared;   // parallel views: (farthest distance twice + reach)^2, at most
	uint tessellates;          // 1: some edge may get two segments, so that bounds must say whether the instance's do
};
SHARED_LAYOUT(RaySharing, 12, tessellates, 8)

// True where no two of the axes that the placement gives the mesh's are far from a right angle: the box that they span has 0.9 of the volume that it
// would have then.
SHARED_FN bool isNearlyOrthogonal(Placement placement)
{
	vec3 x = placement.row0, y = placement.row1, z = placement.row2;
	float minor0 = y.y * z.z - y.z * z.y, minor1 = y.z * z.x - y.x * z.z, minor2 = y.x * z.y - y.y * z.x;
	float volume = x.x * minor0 + x.y * minor1 + x.z * minor2;
	float axis0 = x.x * x.x + y.x * y.x + z.x * z.x;
	float axis1 = x.y * x.y + y.y * y.y + z.y * z.y;
	float axis2 = x.z * x.z + y.z * y.z + z.z * z.z;
	float right_angled = axis0 * axis1 * axis2;
	return right_angled > 0.0f && volume * volume >= 0.81f * right_angled;
}

// Squared distances of a placed box from the eye: at least, at most; and the farthest that anything in it lies from the mesh's origin, squared.
struct SharedSpan
{
	float nearest_squared;
	float farthest_squared;
	float reach_squared;
};

SHARED_FN SharedSpan sharedSpan(Box box, Placement placement)
{
	vec3 half_size = vec3((box.high.x - box.low.x) * 0.5f, (box.high.y - box.low.y) * 0.5f, (box.high.z - box.low.z) * 0.5f);
	vec3 centre = placed(placement, vec3(box.low.x + half_size.x, box.low.y + half_size.y, box.low.z + half_size.z));
	vec3 away = vec3(max(centre.x, -centre.x), max(centre.y, -centre.y), max(centre.z, -centre.z));
	vec3 extent = vec3(extentAlong(placement.row0, half_size), extentAlong(placement.row1, half_size), extentAlong(placement.row2, half_size));
	vec3 corner = vec3(max(box.high.x, -box.low.x), max(box.high.y, -box.low.y), max(box.high.z, -box.low.z));
	vec3 reach = vec3(extentAlong(placement.row0, corner), extentAlong(placement.row1, corner), extentAlong(placement.row2, corner));
	vec3 near_corner = vec3(max(away.x - extent.x, 0.0f), max(away.y - extent.y, 0.0f), max(away.z - extent.z, 0.0f));
	vec3 far_corner = vec3(away.x + extent.x, away.y + extent.y, away.z + extent.z);
	SharedSpan span;
	// What rounding may take of a small difference matters only where the instance is too near anyway.
	span.nearest_squared = near_corner.x * near_corner.x + near_corner.y * near_corner.y + near_corner.z * near_corner.z;
	span.farthest_squared = far_corner.x * far_corner.x + far_corner.y * far_corner.y + far_corner.z * far_corner.z;
	span.reach_squared = reach.x * reach.x + reach.y * reach.y + reach.z * reach.z;
	return span;
}

// True when an instance with these displaced bounds of its mesh may share: the same answer for all of its clusters.
SHARED_FN bool mayShare(DisplacedBounds bounds, Placement placement, RaySharing sharing, View view)
{
	if (!isNearlyOrthogonal(placement))
		return false;
	SharedSpan span = sharedSpan(displacedBox(bounds, view.displacement_scale, view.displacement_offset), placement);
	bool is_exact = span.reach_squared <= sharing.most_reach_squared * span.nearest_squared;
	if (view.distance_weight == 0.0f)
	{
		// (a + b)^2 <= 2 a^2 + 2 b^2
		float squared = 8.0f * span.farthest_squared + 2.0f * span.reach_squared;
		is_exact = squared <= sharing.most_span_squared && squared <= 64.0f * span.nearest_squared;
	}
	return is_exact && (sharing.tessellates == 0u || allFactorsAreOne(bounds, placement, view));
}

SHARED_END

#endif
