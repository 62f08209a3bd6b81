// Rays through pixel centres and where they meet a triangle's plane.
#ifndef TESSERA_LIB_PIXEL_RAY
#define TESSERA_LIB_PIXEL_RAY
#include "shared/view.h"

struct Ray
{
	vec3 origin;     // camera-relative, scaled
	vec3 direction;  // not normalised
};

// `pixel`: position in pixels, centres at .5, y down.
Ray pixelRay(vec2 pixel, View view)
{
	vec3 across = view.ray_first + view.ray_x * pixel.x + view.ray_y * pixel.y;
	bool perspective = view.w_slope != 0.0;
	return Ray(perspective ? view.draw_eye : view.draw_eye + across, perspective ? view.forward + across : view.forward);
}

// Barycentrics of where the ray meets the plane of the triangle; outside the triangle they leave 0..1.
vec3 planeBarycentrics(Ray ray, vec3 p0, vec3 p1, vec3 p2)
{
	vec3 edge1 = p1 - p0;
	vec3 edge2 = p2 - p0;
	vec3 h = cross(ray.direction, edge2);
	float determinant = dot(edge1, h);
	if (determinant == 0.0)
		return vec3(1.0, 0.0, 0.0);
	vec3 s = ray.origin - p0;
	float b1 = dot(s, h) / determinant;
	float b2 = dot(ray.direction, cross(s, edge1)) / determinant;
	return vec3(1.0 - b1 - b2, b1, b2);
}

// The same, held inside the triangle: a pixel centre on its edge may fall outside by rounding.
vec3 insideBarycentrics(vec3 barycentrics)
{
	vec3 clamped = clamp(barycentrics, 0.0, 1.0);
	return clamped / (clamped.x + clamped.y + clamped.z);
}

#endif
