// Where on its base triangle a visible point lies, from the point alone: which pair of a surface point and a length along
// the interpolated direction adds up to it. What a rasteriser left in depth is enough; no micro-vertex is evaluated again.
// Exact where directions are parallel; else it differs from the micro-triangle's own barycentrics by the square of its size.
#ifndef TESSERA_LIB_SURFACE_PLACE
#define TESSERA_LIB_SURFACE_PLACE
#include "lib/pixel_ray.glsl"
#include "lib/pn_shading.glsl"
#include "shared/surface.h"

// Corners have directions: displacement or PN triangles read them.
const bool HAS_DIRECTIONS = HAS_DISPLACEMENT || HAS_PN;

// The point on a pixel's ray at a depth of the visibility image; camera-relative, scaled.
vec3 visiblePoint(Ray ray, float depth, View view)
{
	float distance = (view.depth_offset - depth * view.w_offset) / (depth * view.w_slope - view.depth_slope);
	return ray.origin + ray.direction * distance;
}

vec3 placedDirection(vec3 direction, Placement placement)
{
	return vec3(dot(placement.row0, direction), dot(placement.row1, direction), dot(placement.row2, direction));
}

// A place on a base triangle, and how the displaced surface's point moves with it: by u, by v (w takes what they leave) and
// by the length along the direction.
struct SurfacePlace
{
	vec3 weights;
	vec3 by_u;
	vec3 by_v;
	vec3 by_length;
};

// Coefficients of `vector` in the three columns; zero when they span no volume.
vec3 solveColumns(vec3 column_u, vec3 column_v, vec3 column_t, vec3 vector)
{
	vec3 across = cross(column_v, column_t);
	float determinant = dot(column_u, across);
	vec3 turned = cross(vector, column_u);
	return determinant == 0.0 ? vec3(0.0) : vec3(dot(vector, across), -dot(turned, column_t), dot(turned, column_v)) / determinant;
}

// What PN triangles add to a point of the flat triangle, placed, and how that changes with the weights.
struct PlacedBulge
{
	vec3 at;
	vec3 by_u;
	vec3 by_v;
};

// `along0` to `along2`: the corners' directions, placed.
PlacedBulge placedBulge(PnRises rises, vec3 along0, vec3 along1, vec3 along2, vec3 weights)
{
	PnMoves moves = pnMoves(rises, weights);
	mat3 directions = mat3(along0, along1, along2);
	return PlacedBulge(-(directions * moves.at), -(directions * moves.by_u), -(directions * moves.by_v));
}

// The place whose surface point displaces to `point`. Newton's method on base(u, v) + t direction(u, v) = point, which is
// linear in each of u, v and t alone, but for what PN triangles add; `start`: barycentrics nearby.
SurfacePlace placeOf(vec3 point, TriangleCorners corners, Placement placement, vec3 start)
{
	vec3 p2 = placed(placement, corners.position2);
	vec3 edge_u = placed(placement, corners.position0) - p2;
	vec3 edge_v = placed(placement, corners.position1) - p2;
	vec3 facet = normalize(cross(edge_u, edge_v));
	vec3 d2 = facet, d_u = vec3(0.0), d_v = vec3(0.0);
	PnRises rises;
	vec3 along0, along1, along2;
	if (HAS_PN)
	{
		rises = cornerRises(corners);
		along0 = placedDirection(corners.direction0, placement);
		along1 = placedDirection(corners.direction1, placement);
		along2 = placedDirection(corners.direction2, placement);
	}
	if (HAS_DIRECTIONS)
	{
		d2 = placedDirection(corners.direction2, placement);
		d_u = placedDirection(corners.direction0, placement) - d2;
		d_v = placedDirection(corners.direction1, placement) - d2;
		// Where nothing moves, the point is in the triangle's plane.
		if (dot(d2 + d_u * start.x + d_v * start.y, facet) == 0.0)
		{
			d2 = facet;
			d_u = vec3(0.0);
			d_v = vec3(0.0);
		}
	}
	SurfacePlace place;
	place.weights = start;
	place.by_length = d2 + d_u * start.x + d_v * start.y;
	PlacedBulge bulge = PlacedBulge(vec3(0.0), vec3(0.0), vec3(0.0));
	if (HAS_PN)
		bulge = placedBulge(rises, along0, along1, along2, start);
	vec3 missing = point - p2 - edge_u * start.x - edge_v * start.y - bulge.at;
	float t = dot(missing, facet) / dot(place.by_length, facet);
	missing -= place.by_length * t;
	for (int step = 0; step < (HAS_PN ? 5 : (HAS_DISPLACEMENT ? 3 : 1)); ++step)
	{
		place.by_u = edge_u + d_u * t + bulge.by_u;
		place.by_v = edge_v + d_v * t + bulge.by_v;
		vec3 correction = solveColumns(place.by_u, place.by_v, place.by_length, missing);
		place.weights.xy += correction.xy;
		t += correction.z;
		place.by_length = d2 + d_u * place.weights.x + d_v * place.weights.y;
		if (HAS_PN)
			bulge = placedBulge(rises, along0, along1, along2, vec3(place.weights.xy, 1.0 - place.weights.x - place.weights.y));
		missing = point - p2 - edge_u * place.weights.x - edge_v * place.weights.y - bulge.at - place.by_length * t;
		// What is left shrinks with the square of each correction.
		if (abs(correction.x) + abs(correction.y) < 1e-4)
			break;
	}
	// A triangle seen along its own plane may not converge.
	if (!(abs(place.weights.x) + abs(place.weights.y) < 8.0))
	{
		place.weights = start;
		place.by_u = edge_u;
		place.by_v = edge_v;
	}
	place.weights.z = 1.0 - place.weights.x - place.weights.y;
	return place;
}

// Change of the weights from one pixel's ray to a neighbour's, both met with the plane through `point` across `normal`.
vec3 placeChange(SurfacePlace place, vec3 point, vec3 normal, Ray neighbour)
{
	float along = dot(neighbour.direction, normal);
	vec3 met = neighbour.origin + neighbour.direction * (dot(point - neighbour.origin, normal) / along);
	vec2 change = along == 0.0 ? vec2(0.0) : solveColumns(place.by_u, place.by_v, place.by_length, met - point).xy;
	return vec3(change, -change.x - change.y);
}

#endif
