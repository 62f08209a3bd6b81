// PN triangles where light falls on them: how the patch's point moves with the weights, and the normal that its light is computed with. Free of the
// rules of shared/pn.h: nothing here decides where a vertex is.
// Source: Vlachos, Peters, Boyd and Mitchell, Curved PN Triangles (2001).
#ifndef TESSERA_LIB_PN_SHADING
#define TESSERA_LIB_PN_SHADING
#include "shared/surface.h"

// The coefficients of the three directions (shared/pn.h), and how they change with the weights of corners 0 and 1 (corner 2 takes what they leave).
struct PnMoves
{
	vec3 at;
	vec3 by_u;
	vec3 by_v;
};

PnMoves pnMoves(PnRises rises, vec3 weights)
{
	// Columns by the weight that a rise goes with.
	vec3 r0 = vec3(0.0, rises.r10, rises.r20), r1 = vec3(rises.r01, 0.0, rises.r21), r2 = vec3(rises.r02, rises.r12, 0.0);
	vec3 along = r0 * weights.x + r1 * weights.y + r2 * weights.z;
	vec3 both = r0 + r1 + r2;
	vec3 squared = weights * weights;
	vec3 middles = 0.5 * weights.yzx * weights.zxy;
	vec3 own = 2.0 * weights * along;
	PnMoves moves;
	moves.at = squared * along + both * (middles.x * weights.x);
	vec3 by_w = squared * r2 + both * middles.z + vec3(0.0, 0.0, own.z);
	moves.by_u = squared * r0 + both * middles.x + vec3(own.x, 0.0, 0.0) - by_w;
	moves.by_v = squared * r1 + both * middles.y + vec3(0.0, own.y, 0.0) - by_w;
	return moves;
}

PnRises cornerRises(TriangleCorners corners)
{
	return pnRises(corners.position0, corners.position1, corners.position2, corners.direction0, corners.direction1, corners.direction2);
}

// The control normal of an edge: the mean of its ends' normals, mirrored at the plane across the edge, so that the normal can swing along it. Both
// sides of a smooth edge have the same.
vec3 edgeNormal(vec3 from, vec3 to, vec3 normal_from, vec3 normal_to)
{
	vec3 along = to - from, sum = normal_from + normal_to;
	float squared = dot(along, along);
	vec3 mirrored = squared > 0.0 ? sum - along * (2.0 * dot(along, sum) / squared) : sum;
	float length_squared = dot(mirrored, mirrored);
	return length_squared > 0.0 ? mirrored * inversesqrt(length_squared) : vec3(0.0);
}

// Authored normal at a point of a base triangle, not normalised: linear on flat triangles, quadratic on PN triangles. `normals`: of the corners.
vec3 authoredNormal(TriangleCorners corners, vec3 normals[3], vec3 weights)
{
	if (!HAS_PN)
		return normals[0] * weights.x + normals[1] * weights.y + normals[2] * weights.z;
	vec3 squared = weights * weights;
	vec3 ends = normals[0] * squared.x + normals[1] * squared.y + normals[2] * squared.z;
	return ends + edgeNormal(corners.position0, corners.position1, normals[0], normals[1]) * (weights.x * weights.y) +
	       edgeNormal(corners.position1, corners.position2, normals[1], normals[2]) * (weights.y * weights.z) +
	       edgeNormal(corners.position2, corners.position0, normals[2], normals[0]) * (weights.z * weights.x);
}

#endif
