// pn.h: PN triangles: the base surface as a cubic patch over each base triangle, curved between its corners as their directions say. In the paper's
// terms: an edge's two control points lie in the tangent planes of its ends, b = (2 P_i + P_j - w_ij N_i) / 3 with w_ij = (P_j - P_i) . N_i, the
// middle one half as far again beyond their mean. Written as what is taken away from the flat triangle, so that corners are exact and flat stays
// flat:
//   flat - sum over i of N_i c_i,  c_i = sum over j != i of w_ij (l_i^2 l_j + l_0 l_1 l_2 / 2),  l: barycentric weights
// N is the welded direction and not the authored normal, which may differ on the two sides of an edge; a direction of zero leaves its end flat.
// On an edge the third corner's terms are zeros and the other two add up in either order: both sides compute the same bits. No function here calls
// for a canonical end. Source: Vlachos, Peters, Boyd and Mitchell, Curved PN Triangles (2001); docs/numerics.md.
#ifndef TESSERA_SHARED_PN_H
#define TESSERA_SHARED_PN_H
#include "shared/lang.h"

SHARED_BEGIN

#define PN_LEAST 8.271806125530277e-25f  // 2^-80, mesh units: what curvature adds below it counts as nothing, so that no denormal decides

// w_ij of a triangle's corners, mesh units: how far corner j lies above the tangent plane of corner i.
struct PnRises
{
	float r01;
	float r02;
	float r10;
	float r12;
	float r20;
	float r21;
};

SHARED_FN precise float pnRise(vec3 from, vec3 to, vec3 direction)
{
	precise float x = (to.x - from.x) * direction.x;
	precise float y = (to.y - from.y) * direction.y;
	precise float z = (to.z - from.z) * direction.z;
	precise float xy = x + y;
	precise float sum = xy + z;
	return sum;
}

SHARED_FN PnRises pnRises(vec3 p0, vec3 p1, vec3 p2, vec3 n0, vec3 n1, vec3 n2)
{
	PnRises rises;
	rises.r01 = pnRise(p0, p1, n0);
	rises.r02 = pnRise(p0, p2, n0);
	rises.r10 = pnRise(p1, p0, n1);
	rises.r12 = pnRise(p1, p2, n1);
	rises.r20 = pnRise(p2, p0, n2);
	rises.r21 = pnRise(p2, p1, n2);
	return rises;
}

// c_i: `own`, `next` and `other` are the weights of corner i and of those that the rises belong to.
SHARED_FN precise float pnCoefficient(float rise_next, float rise_other, float own, float next, float other, float middle)
{
	precise float squared = own * own;
	precise float share_next = squared * next + middle;
	precise float share_other = squared * other + middle;
	precise float sum = rise_next * share_next + rise_other * share_other;
	return sum;
}

SHARED_FN precise vec3 pnCoefficients(PnRises rises, vec3 weights)
{
	precise float middle = (weights.x * weights.y) * weights.z * 0.5f;
	precise vec3 result;
	result.x = pnCoefficient(rises.r01, rises.r02, weights.x, weights.y, weights.z, middle);
	result.y = pnCoefficient(rises.r12, rises.r10, weights.y, weights.z, weights.x, middle);
	result.z = pnCoefficient(rises.r20, rises.r21, weights.z, weights.x, weights.y, middle);
	return result;
}

SHARED_FN precise float pnTakenAway(float flat_coordinate, float n0, float n1, float n2, vec3 coefficients)
{
	precise float first_two = n0 * coefficients.x + n1 * coefficients.y;
	precise float sum = first_two + n2 * coefficients.z;
	precise float result = flat_coordinate - sum;
	return max(sum, -sum) < PN_LEAST ? flat_coordinate : result;
}

// The point of the patch over a point of the flat triangle. `n0` to `n2`: directions at the corners, unit or zero.
SHARED_FN precise vec3 pnPoint(vec3 flat_point, PnRises rises, vec3 n0, vec3 n1, vec3 n2, vec3 weights)
{
	precise vec3 coefficients = pnCoefficients(rises, weights);
	precise vec3 result;
	result.x = pnTakenAway(flat_point.x, n0.x, n1.x, n2.x, coefficients);
	result.y = pnTakenAway(flat_point.y, n0.y, n1.y, n2.y, coefficients);
	result.z = pnTakenAway(flat_point.z, n0.z, n1.z, n2.z, coefficients);
	return result;
}

SHARED_END

#endif
