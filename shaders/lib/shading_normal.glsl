// The normal of the displaced surface, smooth under any rate: the authored normal turned by the height's gradient.
// Source: Mikkelsen, Bump Mapping Unparametrized Surfaces on the GPU (2010), with the height's gradient in the domain.
#ifndef TESSERA_LIB_SHADING_NORMAL
#define TESSERA_LIB_SHADING_NORMAL
#include "shared/surface.h"

// Mip level whose texels are about one pixel wide at a point: normals show what the height map holds, not the rate.
float pixelHeightLevel(vec3 relative, Placement placement, float density, uint level_count, View view)
{
	float pixels_per_unit = view.focal_y * float(view.height_px) * 0.5;
	float distance_squared = view.distance_weight > 0.0 ? rateDistanceSquared(relative, view) : 1.0;
	float pixel_squared = distance_squared / (pixels_per_unit * pixels_per_unit);
	return heightLevel(pixel_squared * placement.inverse_scale_squared * density * density, level_count);
}

// Change of the displacement per unit of texture coordinate, by central differences over two texels of the level.
vec2 heightGradient(Surface surface, uint map_index, vec2 uv, float level)
{
	HeightMap map = surface.height_maps.at[map_index];
	vec2 texel = exp2(level) / vec2(map.width, map.height);
	float right = heightAt(surface, map_index, uv + vec2(texel.x, 0.0), level);
	float left = heightAt(surface, map_index, uv - vec2(texel.x, 0.0), level);
	float up = heightAt(surface, map_index, uv + vec2(0.0, texel.y), level);
	float down = heightAt(surface, map_index, uv - vec2(0.0, texel.y), level);
	return vec2(right - left, up - down) / (2.0 * texel) * map.factor;
}

struct ShadingSurface
{
	vec3 normal;         // mesh space, not normalised
	float displacement;  // mesh units
};

// `weights`: barycentrics within the base triangle. `smooth_normal`: interpolated authored normal, mesh space.
ShadingSurface displacedNormal(Surface surface, BaseTriangle base, vec3 weights, vec3 smooth_normal, Placement placement, View view)
{
	ShadingSurface result = ShadingSurface(smooth_normal, 0.0);
	if (!HAS_DISPLACEMENT || base.height_map == NO_INDEX)
		return result;
	vec3 p0 = surface.positions.at[base.v0], p1 = surface.positions.at[base.v1], p2 = surface.positions.at[base.v2];
	vec3 d0 = surface.directions.at[base.v0], d1 = surface.directions.at[base.v1], d2 = surface.directions.at[base.v2];
	vec2 uv0 = surface.uvs.at[base.v0], uv1 = surface.uvs.at[base.v1], uv2 = surface.uvs.at[base.v2];
	HeightSource source = ownHeightSource(surface, base, weights);
	vec3 base_point = weightedVec3(p0, p1, p2, weights);

	HeightMap map = surface.height_maps.at[base.height_map];
	float level = pixelHeightLevel(placed(placement, base_point), placement, source.density, map.level_count, view);
	result.displacement = (heightAt(surface, base.height_map, source.uv, level) * map.factor + map.offset) * view.displacement_scale;
	vec2 gradient = heightGradient(surface, base.height_map, source.uv, level) * view.displacement_scale;
	float slope_u = dot(gradient, uv0 - uv2);
	float slope_v = dot(gradient, uv1 - uv2);

	// Tangents of the surface moved out by the height, before the height itself changes.
	vec3 tangent_u = p0 - p2 + (d0 - d2) * result.displacement;
	vec3 tangent_v = p1 - p2 + (d1 - d2) * result.displacement;
	vec3 n = normalize(smooth_normal);
	vec3 r_u = cross(tangent_v, n);
	vec3 r_v = cross(n, tangent_u);
	float determinant = dot(tangent_u, r_u);
	result.normal = abs(determinant) * n - sign(determinant) * (slope_u * r_u + slope_v * r_v);
	if (dot(result.normal, result.normal) == 0.0)
		result.normal = n;
	return result;
}

#endif
