// Where rays start that leave a visible surface. The corners of the micro-triangle are evaluated by the function that made the vertices which rays
// are traced through, so they are the same bits: what the displaced position is off by does not come between the two.
#ifndef TESSERA_LIB_RAY_ORIGIN
#define TESSERA_LIB_RAY_ORIGIN
#define NEEDS_EXACT_PLACES
#include "lib/pixel_ray.glsl"
#include "lib/visible_triangle.glsl"
#include "lib/visibility_buffer.glsl"

layout(set = 0, binding = 1) uniform utexture2D visibility_payload;
layout(set = 0, binding = 2) uniform texture2D visibility_depth;

// Of the largest coordinate of the triangle, relative to the eye: what point, origin and the device's own test are off by together, across the
// triangle's plane. docs/numerics.md derives it.
const float ORIGIN_OFFSET = 64.0 / 16777216.0;

struct RayOrigin
{
	bool exists;  // false: nothing is seen there
	vec3 point;   // relative to the eye, scaled; off the surface, on the side that is seen
	vec3 normal;  // of the micro-triangle, unit, to the side that is seen; zero where it has no area
};

// The payload at a pixel, and whether it sees anything.
bool visiblePayload(uvec2 place, uint64_t words, View view, out uint payload)
{
	if (READS_BUFFER)
	{
		uint64_t word = VisibilityRef(words).at[place.y * view.width_px + place.x];
		payload = uint(word);
		return word != 0ul;
	}
	payload = texelFetch(visibility_payload, ivec2(place), 0).x;
	return texelFetch(visibility_depth, ivec2(place), 0).x != 0.0;
}

float largestCoordinate(vec3 p) { return max(abs(p.x), max(abs(p.y), abs(p.z))); }

// `more_offset`: beyond ORIGIN_OFFSET, where what rays are traced through is not the same bits.
RayOrigin rayOrigin(RasterInputs inputs, uint64_t words, uvec2 place, View view, float more_offset)
{
	RayOrigin origin = RayOrigin(false, vec3(0.0), vec3(0.0));
	uint payload;
	if (!visiblePayload(place, words, view, payload))
		return origin;
	VisibleTriangle visible = visibleTriangle(inputs, payload);
	vec3 p0 = visible.relative[0], p1 = visible.relative[1], p2 = visible.relative[2];
	Ray ray = pixelRay(vec2(place) + 0.5, view);
	vec3 b = insideBarycentrics(planeBarycentrics(ray, p0, p1, p2));
	vec3 point = p0 * b.x + p1 * b.y + p2 * b.z;
	vec3 facet = cross(p1 - p0, p2 - p0);
	float squared = dot(facet, facet);
	vec3 normal = squared > 0.0 ? facet * inversesqrt(squared) : vec3(0.0);
	normal = dot(normal, ray.direction) > 0.0 ? -normal : normal;
	float largest = max(largestCoordinate(p0), max(largestCoordinate(p1), largestCoordinate(p2)));
	return RayOrigin(true, point + normal * (largest * (ORIGIN_OFFSET + more_offset)), normal);
}

#endif
