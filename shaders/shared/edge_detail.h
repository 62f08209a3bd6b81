// edge_detail.h: metrics that ask how straight the displaced surface is along and beside an edge (`detail`), or how long it is there and how it
// faces the eye (`displaced`), from tables made at load. An edge may use only what all its triangles share: its ends, the eye, and what the tables
// hold for the welded edge; edges inside a base triangle belong to that one alone. As in edge_factor.h nothing is divided where a device could round
// it its own way: logarithms are exponent and mantissa bits, in integers. Source: docs/numerics.md; src/scene/build/edge_detail.h makes the tables.
#ifndef TESSERA_SHARED_EDGE_DETAIL_H
#define TESSERA_SHARED_EDGE_DETAIL_H
#include "shared/edge_factor.h"
#include "shared/geometry.h"

SHARED_BEGIN

// Logarithms to the base of two, linear between powers of two, in 1/256.
#define LOG_ONE 256
#define LOG_NEVER 16384  // 64: no length that occurs is as long

// A curve: how far the displaced surface lies from flat pieces of 1, 2, 4 .. 128 segments per base edge. 8 bits each, log2 of mesh units in 1/8 above
// the scene's bias, rounded up; never rising. 0: it does not.
#define CURVE_STEP 32  // of a curve's unit, in LOG_ONE / 256
#define CURVE_LENGTHS 8u

SHARED_FN int logOf(float value)
{
	return (int(floatBitsToUint(value) >> 15)) - 127 * LOG_ONE;
}

// The number whose logarithm that is, 2^-120 to 2^120: logOf backwards.
SHARED_FN float powerOf(int logarithm)
{
	int bounded = logarithm < -120 * LOG_ONE ? -120 * LOG_ONE : (logarithm > 120 * LOG_ONE ? 120 * LOG_ONE : logarithm);
	return uintBitsToFloat(uint(bounded + 127 * LOG_ONE) << 15);
}

// The base triangle that an edge is on or in.
struct EdgeBase
{
	uint triangle;                // global index
	float inverse_scale_squared;  // (mesh units per scaled world unit)^2 of its instance
	float reach;                  // Placement::triangle_reach of its instance
	float hidden_squared;         // Placement::hidden_squared of its instance
};

// What all edges of an instance that is hidden have added to the squared distance that decides their segments, where light's rays alone meet them, as
// unseenSquared for one that is out of view. A constant of the instance: both sides of an edge know it, and splitting ends as without.
SHARED_FN precise float hiddenSquared(float distance_world, View view)
{
	precise float distance = distance_world * view.unit;
	precise float squared = distance * distance;
	precise float grown = squared * view.unseen_growth;
	return grown;
}

// As placementOf, where factors of edges are to be decided.
SHARED_FN Placement placementForEdges(InstanceRecord instance, uint index, Surface surface, View view)
{
	Placement placement = placementOf(instance, view);
	if (HAS_HIDDEN_FALLOFF && IS_GIVEN(surface.hidden_instances))
		placement.hidden_squared = hiddenSquared(AT(HiddenInstance, surface.hidden_instances, index).distance_world, view);
	return placement;
}

// Which base edge p-q lies on (from corner e to e + 1); 3: none.
SHARED_FN uint baseEdgeOf(DomainPoint p, DomainPoint q)
{
	if (domainW(p) == 0u && domainW(q) == 0u)
		return 0u;
	if (p.u == 0u && q.u == 0u)
		return 1u;
	return p.v == 0u && q.v == 0u ? 2u : 3u;
}

SHARED_FN int curveAt(uint low, uint high, uint i)
{
	uint word = i < 4u ? low : high;
	return int((word >> (8u * (i & 3u))) & 0xffu) * CURVE_STEP;
}

// log2 of the longest segment, domain units, whose pieces stay within the tolerance (log2 of mesh units above the bias). Between two lengths the
// deviation is taken for a power of the length; beyond the curve's ends too, at least linear in it for longer ones, so that the length ends. The
// larger the tolerance the longer.
SHARED_FN int longestWithin(uint low, uint high, int tolerance)
{
	int before = curveAt(low, high, 0u);
	int next = curveAt(low, high, 1u);
	if (before == 0)
		return LOG_NEVER;
	if (tolerance >= before)
		return 23 * LOG_ONE + (tolerance - before) * LOG_ONE / (before - next > LOG_ONE ? before - next : LOG_ONE);
	int slope = 0;
	for (uint i = 1u; i < CURVE_LENGTHS; ++i)
	{
		int here = curveAt(low, high, i);
		slope = before - here;
		if (tolerance >= here)
			return (23 - int(i)) * LOG_ONE + (tolerance - here) * LOG_ONE / slope;
		before = here;
	}
	return 16 * LOG_ONE - (before - tolerance) * LOG_ONE / (slope > CURVE_STEP ? slope : CURVE_STEP);
}

// 1 / x for x > 0 by a bit-trick start and four Newton steps, equal on every device.
SHARED_FN precise float inverseOf(float x)
{
	precise float inverse = uintBitsToFloat(0x7ef311c7u - floatBitsToUint(x));
	for (int step = 0; step < 4; ++step)
	{
		precise float product = x * inverse;
		precise float correction = 2.0f - product;
		inverse = inverse * correction;
	}
	return inverse;
}

// As rateDistanceSquared, of the edge's nearest point and not of an end: no part of an edge is nearer than the edge. Symmetric in its ends.
SHARED_FN precise float nearestDistanceSquared(vec3 p, vec3 q, float length_squared, float ends_squared, View view)
{
	precise float along_x = p.x - q.x;
	precise float along_y = p.y - q.y;
	precise float along_z = p.z - q.z;
	precise float from_p_xy = along_x * p.x + along_y * p.y;
	precise float from_p = from_p_xy + along_z * p.z;
	precise float from_q_xy = along_x * q.x + along_y * q.y;
	precise float from_q = from_q_xy + along_z * q.z;
	// The foot of the eye lies beyond an end.
	if (from_p <= 0.0f || from_q >= 0.0f || view.distance_weight == 0.0f || length_squared < 1e-30f)
		return ends_squared;
	precise float area_x = p.y * q.z - p.z * q.y;
	precise float area_y = p.z * q.x - p.x * q.z;
	precise float area_z = p.x * q.y - p.y * q.x;
	precise float area_xy = area_x * area_x + area_y * area_y;
	precise float area_squared = area_xy + area_z * area_z;
	precise float squared = area_squared * inverseOf(length_squared);
	return min(max(squared, view.distance_floor_squared), ends_squared);
}

// What deviations and lengths of the tables are multiplied by, squared: the displacement scale; with PN triangles at least 1, as the scale leaves
// the base surface's own curvature as it is.
SHARED_FN precise float tableScaleSquared(Surface surface, View view)
{
	precise float squared = view.displacement_scale * view.displacement_scale;
	return HAS_PN && IS_GIVEN(surface.pn_directions) ? max(squared, 1.0f) : squared;
}

// Share of the rate that the surface may lie off its pieces, squared. Chosen by measurement: docs/numerics.md.
#define DETAIL_TOLERANCE_SQUARED 0.25f

// Metric `detail`: segments as long as those of `edge`, or longer where the displaced surface stays near its pieces all the same. A part of an edge
// never asks for more than the edge: splitting ends.
SHARED_FN EdgeView edgeByDetail(EdgeView edge, Surface surface, EdgeBase base, DomainPoint p, DomainPoint q, vec3 relative_p, vec3 relative_q,
								float unseen_squared, View view)
{
	EdgeView result = edge;
	uint domain_length = domainLength(p, q);
	// Flat pieces of a flat surface are the surface.
	bool is_flat = !HAS_DISPLACEMENT && !HAS_PN;
	if (is_flat)
		result.unit_squared = uintBitsToFloat(0x7f800000u);
	if (is_flat || domain_length == 0u)
		return result;
	precise float ends_squared = min(rateDistanceSquared(relative_p, view), rateDistanceSquared(relative_q, view));
	precise float distance_squared = nearestDistanceSquared(relative_p, relative_q, edge.length_squared, ends_squared, view);
	if (HAS_RAY_FALLOFF)
		distance_squared = distance_squared + unseen_squared;
	precise float segment_squared = distance_squared * view.rate_over_focal_squared;
	precise float tolerance_squared = segment_squared * DETAIL_TOLERANCE_SQUARED;
	precise float mesh_tolerance_squared = tolerance_squared * base.inverse_scale_squared;
	int tolerance = ((logOf(mesh_tolerance_squared) - logOf(tableScaleSquared(surface, view))) >> 1) -
					AT(TriangleDetail, surface.triangle_details, base.triangle).bias * CURVE_STEP;
	int bounded = tolerance < -LOG_NEVER ? -LOG_NEVER : (tolerance > LOG_NEVER ? LOG_NEVER : tolerance);
	uint first = 2u * baseEdgeOf(p, q);
	uint low = AT(TriangleDetail, surface.triangle_details, base.triangle).curves[first];
	uint high = AT(TriangleDetail, surface.triangle_details, base.triangle).curves[first + 1u];
	int unit = logOf(edge.length_squared) + 2 * (longestWithin(low, high, bounded) - logOf(float(domain_length)));
	result.unit_squared = max(edge.unit_squared, powerOf(unit));
	return result;
}

// Metric `displaced`: the edge as long as the displaced surface is along it, and as much shorter as it is seen from its end: what of it lies across
// the view, at least a quarter, and what displacement adds, which faces every way. `roughness`: (displaced length / length)^2 - 1 at scale 1.
SHARED_FN EdgeView edgeAsDisplaced(EdgeView edge, vec3 p, vec3 q, float roughness, float scale_squared, View view)
{
	vec3 sight = vec3(view.forward.x, view.forward.y, view.forward.z);
	precise float middle_x = p.x + q.x;
	precise float middle_y = p.y + q.y;
	precise float middle_z = p.z + q.z;
	if (view.distance_weight != 0.0f)
		sight = vec3(middle_x, middle_y, middle_z);
	precise float along_x = p.x - q.x;
	precise float along_y = p.y - q.y;
	precise float along_z = p.z - q.z;
	precise float sight_xy = sight.x * sight.x + sight.y * sight.y;
	precise float sight_squared = sight_xy + sight.z * sight.z;
	precise float dot_xy = along_x * sight.x + along_y * sight.y;
	precise float dot_all = dot_xy + along_z * sight.z;
	// Everything times |sight|^2, so that nothing is divided.
	precise float whole = edge.length_squared * sight_squared;
	precise float end_on = dot_all * dot_all;
	precise float across = whole - end_on;
	precise float ends_squared = min(rateDistanceSquared(p, view), rateDistanceSquared(q, view));
	precise float twice_squared = edge.length_squared * 4.0f;
	// Parts of an edge longer than half its distance can face the eye quite otherwise: it counts in full, or splitting might not end.
	bool is_long = view.distance_weight != 0.0f && twice_squared > ends_squared;
	precise float least = whole * (is_long ? 1.0f : 0.0625f);
	precise float added_share = scale_squared * roughness;
	precise float added = added_share * whole;
	precise float seen = max(across, least);
	precise float length_squared = seen + added;
	precise float unit_squared = edge.unit_squared * sight_squared;
	EdgeView result;
	result.length_squared = length_squared;
	result.unit_squared = unit_squared;
	result.limit = edge.limit;
	return result;
}

// The roughness of the base edge that p-q lies on; inside the triangle the least of its three, so that what lies
// close beside an edge is not cut finer than it, over and over.
SHARED_FN float roughnessAlong(Surface surface, uint triangle, DomainPoint p, DomainPoint q)
{
	vec3 roughness = AT(vec3, surface.edge_roughness, triangle);
	uint e = baseEdgeOf(p, q);
	if (e == 3u)
		return min(roughness.x, min(roughness.y, roughness.z));
	return e == 0u ? roughness.x : (e == 1u ? roughness.y : roughness.z);
}

// The edge from p to q, domain points of a base triangle with camera-relative positions, by the frame's metric. Symmetric in its ends.
SHARED_FN EdgeView edgeByMetric(Surface surface, EdgeBase base, DomainPoint p, DomainPoint q, vec3 relative_p, vec3 relative_q, View view)
{
	precise float unseen_squared = 0.0f;
	if (HAS_RAY_FALLOFF)
		unseen_squared = unseenSquared(relative_p, relative_q, base.reach, view) + base.hidden_squared;
	EdgeView edge = viewEdge(relative_p, relative_q, domainLength(p, q), unseen_squared, view);
	if (HAS_DETAIL && IS_GIVEN(surface.triangle_details))
		return edgeByDetail(edge, surface, base, p, q, relative_p, relative_q, unseen_squared, view);
	if (HAS_DISPLACED_EDGES && IS_GIVEN(surface.edge_roughness))
	{
		float roughness = 0.0f;
		if (HAS_DISPLACEMENT || HAS_PN)
			roughness = roughnessAlong(surface, base.triangle, p, q);
		return edgeAsDisplaced(edge, relative_p, relative_q, roughness, tableScaleSquared(surface, view), view);
	}
	return edge;
}

SHARED_END

#endif
