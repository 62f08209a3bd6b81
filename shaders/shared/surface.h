// surface.h: the displaced surface at a domain point. Every stage that needs a micro-vertex, and the CPU reference, calls
// this; on an edge only data that both sides share enters. Source: DESIGN.md, sections 5 and 7.
#ifndef TESSERA_SHARED_SURFACE_H
#define TESSERA_SHARED_SURFACE_H
#include "shared/height.h"
#include "shared/pn.h"
#include "shared/view.h"

SHARED_BEGIN

// A base triangle, ready to be evaluated.
struct BaseTriangle
{
	uint v0;  // global vertex indices of its corners
	uint v1;
	uint v2;
	uint flags;  // the packed triangle
	uint first_seam_edge;
	uint height_map;  // of its material; NO_INDEX: not displaced
};

// What the points of a base triangle are interpolated from.
struct TriangleCorners
{
	vec3 position0;  // mesh units
	vec3 position1;
	vec3 position2;
	vec3 direction0;  // not set when nothing is displaced and triangles are flat
	vec3 direction1;
	vec3 direction2;
	vec2 uv0;  // not set, as what follows, when nothing is displaced
	vec2 uv1;
	vec2 uv2;
	vec3 densities;  // height texels per mesh unit at the three corners
};

// Where a height is read: coordinate, density and map, which an owner across a seam may have replaced.
struct HeightSource
{
	vec2 uv;
	float density;
	uint height_map;
};

struct SurfacePoint
{
	vec3 base;       // mesh units
	vec3 displaced;  // mesh units
};

// Barycentric weights of a domain point, exact.
SHARED_FN precise vec3 domainWeights(DomainPoint p)
{
	precise vec3 weights;
	weights.x = float(p.u) * 1.1920928955078125e-07f;
	weights.y = float(p.v) * 1.1920928955078125e-07f;
	weights.z = float(domainW(p)) * 1.1920928955078125e-07f;
	return weights;
}

// (a wx + b wy) + c wz: where one weight is 0 the order of the other two does not matter (IEEE addition commutes).
SHARED_FN precise float weighted(float a, float b, float c, vec3 weights)
{
	precise float ab = a * weights.x + b * weights.y;
	precise float sum = ab + c * weights.z;
	return sum;
}

SHARED_FN precise vec3 weightedVec3(vec3 a, vec3 b, vec3 c, vec3 weights)
{
	precise vec3 result;
	result.x = weighted(a.x, b.x, c.x, weights);
	result.y = weighted(a.y, b.y, c.y, weights);
	result.z = weighted(a.z, b.z, c.z, weights);
	return result;
}

// v / |v| by a bit-trick start and four Newton steps; relative error below 4e-7, zero stays zero, equal on every device.
SHARED_FN precise vec3 normalized(vec3 v)
{
	precise float xy = v.x * v.x + v.y * v.y;
	precise float squared = xy + v.z * v.z;
	precise float half_squared = squared * 0.5f;
	precise float inverse = uintBitsToFloat(0x5f375a86u - (floatBitsToUint(squared) >> 1));
	for (int step = 0; step < 4; ++step)
	{
		precise float error = half_squared * inverse;
		precise float correction = 1.5f - error * inverse;
		inverse = inverse * correction;
	}
	precise vec3 result;
	result.x = v.x * inverse;
	result.y = v.y * inverse;
	result.z = v.z * inverse;
	return result;
}

SHARED_FN BaseTriangle baseTriangle(Surface surface, ClusterRecord cluster, uint triangle)
{
	uint index = cluster.first_triangle + triangle;
	BaseTriangle base;
	base.flags = AT(uint, surface.triangles, index);
	base.v0 = cluster.first_vertex + triangleVertex(base.flags, 0u);
	base.v1 = cluster.first_vertex + triangleVertex(base.flags, 1u);
	base.v2 = cluster.first_vertex + triangleVertex(base.flags, 2u);
	base.first_seam_edge = 0u;
	if (HAS_SEAMS && triangleSeamFlags(base.flags) != 0u)
		base.first_seam_edge = AT(uint, surface.first_seam_edges, index);
	base.height_map = NO_INDEX;
	if (HAS_DISPLACEMENT)
		base.height_map = AT(uint, surface.material_height_maps, cluster.material);
	return base;
}

SHARED_FN TriangleCorners triangleCorners(Surface surface, BaseTriangle base)
{
	TriangleCorners corners;
	corners.position0 = AT(vec3, surface.positions, base.v0);
	corners.position1 = AT(vec3, surface.positions, base.v1);
	corners.position2 = AT(vec3, surface.positions, base.v2);
	if (HAS_DISPLACEMENT || HAS_PN)
	{
		corners.direction0 = AT(vec3, surface.directions, base.v0);
		corners.direction1 = AT(vec3, surface.directions, base.v1);
		corners.direction2 = AT(vec3, surface.directions, base.v2);
	}
	if (HAS_DISPLACEMENT)
	{
		corners.uv0 = AT(vec2, surface.uvs, base.v0);
		corners.uv1 = AT(vec2, surface.uvs, base.v1);
		corners.uv2 = AT(vec2, surface.uvs, base.v2);
		corners.densities.x = AT(float, surface.densities, base.v0);
		corners.densities.y = AT(float, surface.densities, base.v1);
		corners.densities.z = AT(float, surface.densities, base.v2);
	}
	return corners;
}

// The base surface at a point of the triangle: flat, or a PN triangle.
SHARED_FN precise vec3 basePoint(Surface surface, TriangleCorners corners, vec3 weights)
{
	precise vec3 flat_point = weightedVec3(corners.position0, corners.position1, corners.position2, weights);
	if (HAS_PN && IS_GIVEN(surface.pn_directions))
	{
		PnRises rises = pnRises(corners.position0, corners.position1, corners.position2, corners.direction0, corners.direction1, corners.direction2);
		return pnPoint(flat_point, rises, corners.direction0, corners.direction1, corners.direction2, weights);
	}
	return flat_point;
}

// What the triangle itself says about the height at a point.
SHARED_FN HeightSource ownHeightSource(TriangleCorners corners, uint height_map, vec3 weights)
{
	HeightSource source;
	source.uv.x = weighted(corners.uv0.x, corners.uv1.x, corners.uv2.x, weights);
	source.uv.y = weighted(corners.uv0.y, corners.uv1.y, corners.uv2.y, weights);
	source.density = weighted(corners.densities.x, corners.densities.y, corners.densities.z, weights);
	source.height_map = height_map;
	return source;
}

// What the owner of seam edge `edge` says: the same sum with the owner's values at the edge's two ends.
SHARED_FN HeightSource seamEdgeSource(Surface surface, BaseTriangle base, uint edge, vec3 weights)
{
	uint before = triangleSeamFlags(base.flags) & ((1u << edge) - 1u);
	SeamEdge seam = AT(SeamEdge, surface.seam_edges, base.first_seam_edge + uint(bitCount(before)));
	float first = edge == 0u ? weights.x : (edge == 1u ? weights.y : weights.z);
	float second = edge == 0u ? weights.y : (edge == 1u ? weights.z : weights.x);
	vec3 ends = vec3(first, second, 0.0f);
	HeightSource source;
	source.uv.x = weighted(seam.uv_first.x, seam.uv_second.x, 0.0f, ends);
	source.uv.y = weighted(seam.uv_first.y, seam.uv_second.y, 0.0f, ends);
	source.density = weighted(seam.density_first, seam.density_second, 0.0f, ends);
	source.height_map = seam.height_map;
	return source;
}

SHARED_FN HeightSource vertexHeightSource(Surface surface, uint vertex, uint height_map)
{
	HeightSource source;
	source.uv = AT(vec2, surface.uvs, vertex);
	source.density = AT(float, surface.densities, vertex);
	source.height_map = height_map;
	if (HAS_SEAMS)
	{
		uint index = AT(uint, surface.seam_corner_indices, vertex);
		if (index != NO_INDEX)
		{
			SeamCorner corner = AT(SeamCorner, surface.seam_corners, index);
			source.uv = corner.uv;
			source.density = corner.density;
			source.height_map = corner.height_map;
		}
	}
	return source;
}

// The height source at a domain point: the owner's on seam edges and at corners, else the triangle's own. `on_seam`: false
// only when no edge or corner of the triangle has another owner.
SHARED_FN HeightSource heightSource(Surface surface, BaseTriangle base, TriangleCorners corners, bool on_seam, DomainPoint p, vec3 weights)
{
	uint zeros = (p.u == 0u ? 1u : 0u) | (p.v == 0u ? 2u : 0u) | (domainW(p) == 0u ? 4u : 0u);
	if (HAS_SEAMS && on_seam && zeros != 0u)
	{
		if (zeros == 6u)
			return vertexHeightSource(surface, base.v0, base.height_map);
		if (zeros == 5u)
			return vertexHeightSource(surface, base.v1, base.height_map);
		if (zeros == 3u)
			return vertexHeightSource(surface, base.v2, base.height_map);
		uint edge = zeros == 4u ? 0u : (zeros == 1u ? 1u : 2u);
		if ((triangleSeamFlags(base.flags) & (1u << edge)) != 0u)
			return seamEdgeSource(surface, base, edge, weights);
	}
	return ownHeightSource(corners, base.height_map, weights);
}

// Displacement along the direction, mesh units. `base_point` decides the mip level: a function of the point alone.
SHARED_FN precise float displacementAt(Surface surface, HeightSource source, vec3 base_point, Placement placement, View view)
{
	if (source.height_map == NO_INDEX)
		return 0.0f;
	precise float distance_squared = rateDistanceSquared(placed(placement, base_point), view);
	precise float segment_squared = distance_squared * view.sample_over_focal_squared;
	precise float density_squared = source.density * source.density;
	precise float mesh_segment_squared = segment_squared * placement.inverse_scale_squared;
	precise float footprint_squared = mesh_segment_squared * density_squared;
	float level = heightLevel(footprint_squared, HEIGHT_MAP(surface, source.height_map, level_count));
	float height = heightAt(surface, source.height_map, source.uv, level);
	precise float scaled = height * HEIGHT_MAP(surface, source.height_map, factor) + HEIGHT_MAP(surface, source.height_map, offset);
	precise float moved = scaled + view.displacement_offset;
	precise float displacement = moved * view.displacement_scale;
	return displacement;
}

SHARED_FN precise vec3 displacedPoint(vec3 base_point, vec3 direction, float displacement)
{
	precise vec3 result;
	result.x = base_point.x + direction.x * displacement;
	result.y = base_point.y + direction.y * displacement;
	result.z = base_point.z + direction.z * displacement;
	return result;
}

// What a micro-vertex is made of, before its height is read.
struct SurfaceSample
{
	vec3 base;       // mesh units
	vec3 direction;  // not normalised
	HeightSource source;
};

// The sample at domain point p of a base triangle, given its corners. `on_seam` as in heightSource.
SHARED_FN SurfaceSample sampleAtCorners(Surface surface, BaseTriangle base, TriangleCorners corners, bool on_seam, DomainPoint p)
{
	precise vec3 weights = domainWeights(p);
	SurfaceSample result;
	result.base = basePoint(surface, corners, weights);
	result.direction = vec3(0.0f, 0.0f, 0.0f);
	result.source.height_map = NO_INDEX;
	if (HAS_DISPLACEMENT)
	{
		result.direction = weightedVec3(corners.direction0, corners.direction1, corners.direction2, weights);
		result.source = heightSource(surface, base, corners, on_seam, p, weights);
	}
	return result;
}

// The sample at domain point p of a base triangle.
SHARED_FN SurfaceSample sampleAtPoint(Surface surface, BaseTriangle base, DomainPoint p)
{
	return sampleAtCorners(surface, base, triangleCorners(surface, base), true, p);
}

// The sample at a cluster's vertex: bit-equal to sampleAtPoint at that corner of any of its triangles.
SHARED_FN SurfaceSample sampleAtVertex(Surface surface, uint vertex, uint height_map)
{
	SurfaceSample result;
	result.base = AT(vec3, surface.positions, vertex);
	result.direction = vec3(0.0f, 0.0f, 0.0f);
	result.source.height_map = NO_INDEX;
	if (HAS_DISPLACEMENT)
	{
		result.direction = AT(vec3, surface.directions, vertex);
		result.source = vertexHeightSource(surface, vertex, height_map);
	}
	return result;
}

// The displaced point of a sample. Call it once per shader where possible: heights are most of a stage's code.
SHARED_FN SurfacePoint displaced(Surface surface, SurfaceSample at, Placement placement, View view)
{
	SurfacePoint point;
	point.base = at.base;
	point.displaced = at.base;
	if (HAS_DISPLACEMENT)
	{
		float displacement = displacementAt(surface, at.source, at.base, placement, view);
		point.displaced = displacedPoint(at.base, normalized(at.direction), displacement);
	}
	return point;
}

// The micro-vertex at domain point p of a base triangle.
SHARED_FN SurfacePoint surfacePoint(Surface surface, BaseTriangle base, DomainPoint p, Placement placement, View view)
{
	return displaced(surface, sampleAtPoint(surface, base, p), placement, view);
}

// The micro-vertex at a cluster's vertex.
SHARED_FN SurfacePoint surfaceVertex(Surface surface, uint vertex, uint height_map, Placement placement, View view)
{
	return displaced(surface, sampleAtVertex(surface, vertex, height_map), placement, view);
}

SHARED_END

#endif
