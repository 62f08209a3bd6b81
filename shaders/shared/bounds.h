// bounds.h: boxes that contain everything a displaced cluster can reach, and the test against the view's frustum.
// Conservative: base points stay in the box of the vertices (of PN triangles: of their control points), displacement adds
// (direction interval) x (reach interval).
// Source: DESIGN.md, contract C3.
#ifndef TESSERA_SHARED_BOUNDS_H
#define TESSERA_SHARED_BOUNDS_H
#include "shared/view.h"

SHARED_BEGIN

// Bounds of a cluster or of a whole mesh, mesh units.
struct DisplacedBounds
{
	vec3 low;  // box of the undisplaced surface
	vec3 high;
	vec3 direction_low;  // interval, per axis, of every normalised interpolated displacement direction
	vec3 direction_high;
	float reach_low;  // interval of (height * factor + offset) over all mips that may be read; both 0: not displaced
	float reach_high;
	vec3 cone_axis;      // normal cone of the base triangles, unit
	float cone_cutoff;   // back-facing when dot(axis, direction from eye) >= cutoff * length; above 1: never (see scene/)
	float bulge;         // farthest that PN triangles lie from their flat ones; 0 without them
	float longest_edge;  // of the base triangles
};
SHARED_LAYOUT(DisplacedBounds, 80, longest_edge, 76)

// Half of how far a box reaches along an axis; `row`: that axis in the box's own ones.
SHARED_FN float extentAlong(vec3 row, vec3 half_size)
{
	return max(row.x, -row.x) * half_size.x + max(row.y, -row.y) * half_size.y + max(row.z, -row.z) * half_size.z;
}

// What displacement can do within a base triangle, whoever owns its edges and corners, while no mip coarser than
// REACH_FINE_MIP or REACH_COARSE_MIP is read. Intervals as DisplacedBounds.reach_low and reach_high.
#define REACH_FINE_MIP 1
#define REACH_COARSE_MIP 3
struct TriangleReach
{
	vec2 fine;
	vec2 coarse;
	float density;  // largest texel density of any of its points
};
SHARED_LAYOUT(TriangleReach, 20, density, 16)

// A box in mesh units.
struct Box
{
	vec3 low;
	vec3 high;
};

// Interval product [a, b] * [c, d], low and high ends.
SHARED_FN float productLow(float a, float b, float c, float d)
{
	return min(min(a * c, a * d), min(b * c, b * d));
}
SHARED_FN float productHigh(float a, float b, float c, float d)
{
	return max(max(a * c, a * d), max(b * c, b * d));
}

// The box of everything the displaced surface can reach, a hair wider than exact to cover rounding.
SHARED_FN Box displacedBox(DisplacedBounds bounds, float displacement_scale, float displacement_offset)
{
	float moved_low = bounds.reach_low + displacement_offset;
	float moved_high = bounds.reach_high + displacement_offset;
	// What is not displaced stays where it is.
	if (bounds.reach_low <= 0.0f && bounds.reach_high >= 0.0f)
	{
		moved_low = min(moved_low, 0.0f);
		moved_high = max(moved_high, 0.0f);
	}
	float reach_low = min(moved_low * displacement_scale, moved_high * displacement_scale);
	float reach_high = max(moved_low * displacement_scale, moved_high * displacement_scale);
	Box box;
	box.low.x = bounds.low.x + productLow(bounds.direction_low.x, bounds.direction_high.x, reach_low, reach_high);
	box.low.y = bounds.low.y + productLow(bounds.direction_low.y, bounds.direction_high.y, reach_low, reach_high);
	box.low.z = bounds.low.z + productLow(bounds.direction_low.z, bounds.direction_high.z, reach_low, reach_high);
	box.high.x = bounds.high.x + productHigh(bounds.direction_low.x, bounds.direction_high.x, reach_low, reach_high);
	box.high.y = bounds.high.y + productHigh(bounds.direction_low.y, bounds.direction_high.y, reach_low, reach_high);
	box.high.z = bounds.high.z + productHigh(bounds.direction_low.z, bounds.direction_high.z, reach_low, reach_high);
	float size = max(max(box.high.x - box.low.x, box.high.y - box.low.y), box.high.z - box.low.z);
	float far_corner = max(max(max(box.high.x, -box.low.x), max(box.high.y, -box.low.y)), max(box.high.z, -box.low.z));
	float margin = size * 1e-5f + far_corner * 1e-6f;
	box.low.x -= margin;
	box.low.y -= margin;
	box.low.z -= margin;
	box.high.x += margin;
	box.high.y += margin;
	box.high.z += margin;
	return box;
}

// Largest value over a placed box of the plane function normal . view + w_slope * depth + offset, where the normal is
// x * right + y * up + depth * forward; centre and half axes are camera-relative.
SHARED_FN float planeReach(float x, float y, float depth, float offset, vec3 centre, vec3 axis0, vec3 axis1, vec3 axis2, View view)
{
	vec3 normal = vec3(x * view.right.x + y * view.up.x + depth * view.forward.x, x * view.right.y + y * view.up.y + depth * view.forward.y,
					   x * view.right.z + y * view.up.z + depth * view.forward.z);
	float middle = normal.x * centre.x + normal.y * centre.y + normal.z * centre.z + offset;
	float reach0 = normal.x * axis0.x + normal.y * axis0.y + normal.z * axis0.z;
	float reach1 = normal.x * axis1.x + normal.y * axis1.y + normal.z * axis1.z;
	float reach2 = normal.x * axis2.x + normal.y * axis2.y + normal.z * axis2.z;
	float reach = max(reach0, -reach0) + max(reach1, -reach1) + max(reach2, -reach2);
	float rounding = (max(middle, -middle) + reach + max(centre.x, -centre.x) + max(centre.y, -centre.y) + max(centre.z, -centre.z)) * 4e-6f;
	return middle + reach + rounding;
}

// False only when no point of a placed box (centre and half axes) can be inside the view: left, right, bottom, top or
// before the near plane.
SHARED_FN bool placedBoxMayBeVisible(vec3 centre, vec3 axis0, vec3 axis1, vec3 axis2, View view)
{
	return planeReach(view.focal_x, 0.0f, view.w_slope, view.w_offset, centre, axis0, axis1, axis2, view) >= 0.0f &&
		   planeReach(-view.focal_x, 0.0f, view.w_slope, view.w_offset, centre, axis0, axis1, axis2, view) >= 0.0f &&
		   planeReach(0.0f, view.focal_y, view.w_slope, view.w_offset, centre, axis0, axis1, axis2, view) >= 0.0f &&
		   planeReach(0.0f, -view.focal_y, view.w_slope, view.w_offset, centre, axis0, axis1, axis2, view) >= 0.0f &&
		   planeReach(0.0f, 0.0f, 1.0f, -view.near, centre, axis0, axis1, axis2, view) >= 0.0f;
}

// False only when no point of the box can be inside the view.
SHARED_FN bool boxMayBeVisible(Box box, Placement placement, View view)
{
	vec3 middle = vec3((box.low.x + box.high.x) * 0.5f, (box.low.y + box.high.y) * 0.5f, (box.low.z + box.high.z) * 0.5f);
	vec3 half_size = vec3(box.high.x - middle.x, box.high.y - middle.y, box.high.z - middle.z);
	vec3 centre = placed(placement, middle);
	vec3 axis0 = vec3(placement.row0.x * half_size.x, placement.row1.x * half_size.x, placement.row2.x * half_size.x);
	vec3 axis1 = vec3(placement.row0.y * half_size.y, placement.row1.y * half_size.y, placement.row2.y * half_size.y);
	vec3 axis2 = vec3(placement.row0.z * half_size.z, placement.row1.z * half_size.z, placement.row2.z * half_size.z);
	return placedBoxMayBeVisible(centre, axis0, axis1, axis2, view);
}

// Everything that curvature and displacement add to a flat point of a cluster, placed: a centre and three half axes; and how far a point of
// a piece can lie outside its corners, since domain points are rounded to 2^-23 of the base triangle.
struct PlacedReach
{
	vec3 centre;
	vec3 axis0;
	vec3 axis1;
	vec3 axis2;
	float slack;
};

SHARED_FN PlacedReach placedReach(DisplacedBounds bounds, Placement placement, View view)
{
	DisplacedBounds at_origin = bounds;
	float bulge = HAS_PN ? bounds.bulge : 0.0f;
	at_origin.low = vec3(-bulge, -bulge, -bulge);
	at_origin.high = vec3(bulge, bulge, bulge);
	Box box = displacedBox(at_origin, view.displacement_scale, view.displacement_offset);
	vec3 middle = vec3((box.low.x + box.high.x) * 0.5f, (box.low.y + box.high.y) * 0.5f, (box.low.z + box.high.z) * 0.5f);
	vec3 half_size = vec3(box.high.x - middle.x, box.high.y - middle.y, box.high.z - middle.z);
	vec3 size = vec3(bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y, bounds.high.z - bounds.low.z);
	Placement turn = placement;
	turn.translation = vec3(0.0f, 0.0f, 0.0f);
	vec3 extent = vec3(extentAlong(placement.row0, size), extentAlong(placement.row1, size), extentAlong(placement.row2, size));
	PlacedReach reach;
	reach.centre = placed(turn, middle);
	reach.axis0 = vec3(placement.row0.x * half_size.x, placement.row1.x * half_size.x, placement.row2.x * half_size.x);
	reach.axis1 = vec3(placement.row0.y * half_size.y, placement.row1.y * half_size.y, placement.row2.y * half_size.y);
	reach.axis2 = vec3(placement.row0.z * half_size.z, placement.row1.z * half_size.z, placement.row2.z * half_size.z);
	reach.slack = (extent.x + extent.y + extent.z) * 1e-6f;
	return reach;
}

// A box along the world's axes around everything that a displaced piece can reach, camera-relative.
struct PieceBox
{
	vec3 centre;
	vec3 half_size;
};

// Of the piece with undisplaced camera-relative corners p, q, r.
SHARED_FN PieceBox pieceBox(vec3 p, vec3 q, vec3 r, PlacedReach reach)
{
	vec3 low = vec3(min(min(p.x, q.x), r.x) - reach.slack, min(min(p.y, q.y), r.y) - reach.slack, min(min(p.z, q.z), r.z) - reach.slack);
	vec3 high = vec3(max(max(p.x, q.x), r.x) + reach.slack, max(max(p.y, q.y), r.y) + reach.slack, max(max(p.z, q.z), r.z) + reach.slack);
	float x = max(max(reach.axis0.x, -reach.axis0.x) + max(reach.axis1.x, -reach.axis1.x) + max(reach.axis2.x, -reach.axis2.x), 0.0f);
	float y = max(max(reach.axis0.y, -reach.axis0.y) + max(reach.axis1.y, -reach.axis1.y) + max(reach.axis2.y, -reach.axis2.y), 0.0f);
	float z = max(max(reach.axis0.z, -reach.axis0.z) + max(reach.axis1.z, -reach.axis1.z) + max(reach.axis2.z, -reach.axis2.z), 0.0f);
	PieceBox box;
	box.half_size = vec3((high.x - low.x) * 0.5f + x, (high.y - low.y) * 0.5f + y, (high.z - low.z) * 0.5f + z);
	box.centre = vec3((low.x + high.x) * 0.5f + reach.centre.x, (low.y + high.y) * 0.5f + reach.centre.y, (low.z + high.z) * 0.5f + reach.centre.z);
	return box;
}

// False only when no displaced point of the piece can be inside the view.
SHARED_FN bool pieceMayBeVisible(vec3 p, vec3 q, vec3 r, PlacedReach reach, View view)
{
	PieceBox box = pieceBox(p, q, r, reach);
	return placedBoxMayBeVisible(box.centre, vec3(box.half_size.x, 0.0f, 0.0f), vec3(0.0f, box.half_size.y, 0.0f), vec3(0.0f, 0.0f, box.half_size.z),
								 view);
}

// Not below the square of the most that a placement stretches a length: the norm of its matrix times the transposed one, which is exact where
// the three axes are at right angles and scaled alike.
SHARED_FN float stretchSquared(Placement placement)
{
	vec3 x = placement.row0, y = placement.row1, z = placement.row2;
	float xy = x.x * y.x + x.y * y.y + x.z * y.z, xz = x.x * z.x + x.y * z.y + x.z * z.z, yz = y.x * z.x + y.y * z.y + y.z * z.z;
	float xx = x.x * x.x + x.y * x.y + x.z * x.z, yy = y.x * y.x + y.y * y.y + y.z * y.z, zz = z.x * z.x + z.y * z.y + z.z * z.z;
	xy = max(xy, -xy);
	xz = max(xz, -xz);
	yz = max(yz, -yz);
	return max(xx + xy + xz, max(yy + xy + yz, zz + xz + yz));
}

// True only when no edge of the cluster gets two segments by the metric `edge`: the longest edge that it can have here, seen from the point of
// its box that is nearest to the eye, is too short (DESIGN.md, section 5). Most clusters of dense and of far meshes are decided by this.
SHARED_FN bool allFactorsAreOne(DisplacedBounds bounds, Placement placement, View view)
{
	vec3 half_size = vec3((bounds.high.x - bounds.low.x) * 0.5f, (bounds.high.y - bounds.low.y) * 0.5f, (bounds.high.z - bounds.low.z) * 0.5f);
	vec3 centre = placed(placement, vec3(bounds.low.x + half_size.x, bounds.low.y + half_size.y, bounds.low.z + half_size.z));
	vec3 away = vec3(max(centre.x, -centre.x), max(centre.y, -centre.y), max(centre.z, -centre.z));
	vec3 reach = vec3(extentAlong(placement.row0, half_size), extentAlong(placement.row1, half_size), extentAlong(placement.row2, half_size));
	// What rounding may take.
	float room = (away.x + away.y + away.z + reach.x + reach.y + reach.z) * 1e-5f;
	float x = max(away.x - reach.x - room, 0.0f), y = max(away.y - reach.y - room, 0.0f), z = max(away.z - reach.z - room, 0.0f);
	float nearest_squared = max((x * x + y * y + z * z) * view.distance_weight, view.distance_floor_squared);
	float unit_squared = nearest_squared * view.rate_over_focal_squared;
	float longest_squared = bounds.longest_edge * bounds.longest_edge * stretchSquared(placement);
	// An edge gets two from 1.5 units on.
	return longest_squared * 1.001f < 2.25f * unit_squared;
}

SHARED_END

#endif
