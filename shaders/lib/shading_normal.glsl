// The normal of the displaced surface, smooth under any rate: the authored normal turned by the height's gradient.
// Source: Mikkelsen, Bump Mapping Unparametrized Surfaces on the GPU (2010), with the height's gradient in the domain.
#ifndef TESSERA_LIB_SHADING_NORMAL
#define TESSERA_LIB_SHADING_NORMAL
#include "lib/pn_shading.glsl"
#include "shared/surface.h"

// Mip level whose texels are about one pixel wide at a point: normals show what the height map holds, not the rate.
float pixelHeightLevel(vec3 relative, Placement placement, float density, uint level_count, View view)
{
	float pixels_per_unit = view.focal_y * float(view.height_px) * 0.5;
	float distance_squared = view.distance_weight > 0.0 ? rateDistanceSquared(relative, view) : 1.0;
	float pixel_squared = distance_squared / (pixels_per_unit * pixels_per_unit);
	return heightLevel(pixel_squared * placement.inverse_scale_squared * density * density, level_count);
}

// Height and its change per texel of one level: bilinear blends of texels and of their central differences, so that the
// gradient has no steps at texel borders. Twelve texels, in four footprints.
struct HeightSlope
{
	float height;
	vec2 slope;
};

HeightSlope levelSlope(HeightMap map, uint first, vec2 folded, uint level)
{
	ivec2 size = max(ivec2(map.width, map.height) >> level, ivec2(1));
	vec2 texel = folded * vec2(size) - 0.5;
	ivec2 base = ivec2(floor(texel));
	vec2 blend = texel - vec2(base);
	Footprint left = footprintAt(map, first, base.x - 1, base.y, level);
	Footprint right = footprintAt(map, first, base.x + 1, base.y, level);
	Footprint top = footprintAt(map, first, base.x, base.y - 1, level);
	Footprint bottom = footprintAt(map, first, base.x, base.y + 1, level);
	vec4 upper = vec4(left.h00, left.h10, right.h00, right.h10);
	vec4 lower = vec4(left.h01, left.h11, right.h01, right.h11);
	vec2 above = vec2(top.h00, top.h10), below = vec2(bottom.h01, bottom.h11);
	HeightSlope result;
	result.height = mix(mix(upper.y, upper.z, blend.x), mix(lower.y, lower.z, blend.x), blend.y);
	vec2 across = mix(vec2(upper.z - upper.x, upper.w - upper.y), vec2(lower.z - lower.x, lower.w - lower.y), blend.y);
	vec2 down = mix(lower.yz - above, below - upper.yz, blend.y);
	result.slope = 0.5 * vec2(mix(across.x, across.y, blend.x), mix(down.x, down.y, blend.x)) * vec2(size);
	return result;
}

// Displacement, and its change per unit of texture coordinate, blended between two mips.
HeightSlope displacementSlope(Surface surface, uint map_index, vec2 uv, float level)
{
	HeightMap map = heightMapHead(surface, map_index);
	vec2 folded = vec2(foldCoordinate(uv.x, map.wrap_u), foldCoordinate(uv.y, map.wrap_v));
	uint fine = uint(level);
	HeightSlope result = levelSlope(map, HEIGHT_MAP(surface, map_index, level_first[fine]), folded, fine);
	float blend = level - float(fine);
	if (blend > 0.0)
	{
		HeightSlope coarse = levelSlope(map, HEIGHT_MAP(surface, map_index, level_first[fine + 1u]), folded, fine + 1u);
		result.height = mix(result.height, coarse.height, blend);
		result.slope = mix(result.slope, coarse.slope, blend);
	}
	// Mirrored repeats run backwards every other time.
	if (HAS_WRAP_MIRROR && map.wrap_u == WRAP_MIRROR && fract(uv.x * 0.5) >= 0.5)
		result.slope.x = -result.slope.x;
	if (HAS_WRAP_MIRROR && map.wrap_v == WRAP_MIRROR && fract(uv.y * 0.5) >= 0.5)
		result.slope.y = -result.slope.y;
	result.height = result.height * HEIGHT_MAP(surface, map_index, factor) + HEIGHT_MAP(surface, map_index, offset);
	result.slope *= HEIGHT_MAP(surface, map_index, factor);
	return result;
}

// The normal that a height's slope turns `normal` (unit) to, not normalised. `tangent_u`, `tangent_v`: how the surface moves with the weights
// of corners 0 and 1 before the height changes; `slope_u`, `slope_v`: how the height does; `direction`: how the surface moves with the height.
vec3 turnedNormal(vec3 normal, vec3 tangent_u, vec3 tangent_v, vec3 direction, float slope_u, float slope_v)
{
	float determinant = dot(normal, cross(tangent_u, tangent_v));
	vec3 turn = slope_u * cross(tangent_v, direction) + slope_v * cross(direction, tangent_u);
	vec3 turned = abs(determinant) * normal - sign(determinant) * turn;
	return dot(turned, turned) == 0.0 ? normal : turned;
}

struct ShadingSurface
{
	vec3 normal;         // mesh space, not normalised
	float displacement;  // mesh units
};

// `weights`: barycentrics within the base triangle. `normals`: authored, of its corners, mesh space.
ShadingSurface displacedNormal(Surface surface, BaseTriangle base, vec3 weights, vec3 normals[3], Placement placement, View view)
{
	TriangleCorners corners;
	if (HAS_PN || (HAS_DISPLACEMENT && base.height_map != NO_INDEX))
		corners = triangleCorners(surface, base);
	vec3 smooth_normal = authoredNormal(corners, normals, weights);
	ShadingSurface result = ShadingSurface(smooth_normal, 0.0);
	if (!HAS_DISPLACEMENT || base.height_map == NO_INDEX)
		return result;
	HeightSource source = ownHeightSource(corners, base.height_map, weights);
	vec3 base_point = basePoint(surface, corners, weights);

	uint level_count = HEIGHT_MAP(surface, base.height_map, level_count);
	float level = pixelHeightLevel(placed(placement, base_point), placement, source.density, level_count, view);
	HeightSlope height = displacementSlope(surface, base.height_map, source.uv, level);
	result.displacement = (height.height + view.displacement_offset) * view.displacement_scale;
	vec2 gradient = height.slope * view.displacement_scale;
	float slope_u = dot(gradient, corners.uv0 - corners.uv2);
	float slope_v = dot(gradient, corners.uv1 - corners.uv2);

	// Tangents of the surface moved out by the height, before the height itself changes.
	vec3 d0 = corners.direction0, d1 = corners.direction1, d2 = corners.direction2;
	vec3 tangent_u = corners.position0 - corners.position2 + (d0 - d2) * result.displacement;
	vec3 tangent_v = corners.position1 - corners.position2 + (d1 - d2) * result.displacement;
	if (HAS_PN)
	{
		PnMoves moves = pnMoves(cornerRises(corners), weights);
		tangent_u -= d0 * moves.by_u.x + d1 * moves.by_u.y + d2 * moves.by_u.z;
		tangent_v -= d0 * moves.by_v.x + d1 * moves.by_v.y + d2 * moves.by_v.z;
	}
	vec3 normal = normalize(smooth_normal);
	result.normal = turnedNormal(normal, tangent_u, tangent_v, normal, slope_u, slope_v);
	return result;
}

#endif
