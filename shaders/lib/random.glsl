// Numbers that look random and are the same in every frame.
#ifndef TESSERA_LIB_RANDOM
#define TESSERA_LIB_RANDOM

// Two hashes of a pixel, 0..1. Source: Jarzynski and Olano, Hash Functions for GPU Rendering (2020), pcg2d.
vec2 pixelHash(uvec2 pixel)
{
	uvec2 v = pixel * 1664525u + 1013904223u;
	v.x += v.y * 1664525u;
	v.y += v.x * 1664525u;
	v ^= v >> 16;
	v.x += v.y * 1664525u;
	v.y += v.x * 1664525u;
	v ^= v >> 16;
	return vec2(v >> 8) / 16777216.0;
}

// The i-th of a sequence that fills the unit square evenly, moved by `shift`. Source: Roberts, R2 sequence (2018).
vec2 evenPoint(uint i, vec2 shift) { return fract(shift + float(i) * vec2(0.7548776662466927, 0.5698402909980532)); }

// A direction around `normal` (unit) with a density of cosine / pi.
vec3 cosineDirection(vec3 normal, vec2 at)
{
	// A frame around the normal. Source: Duff et al., Building an Orthonormal Basis, Revisited (2017).
	float sign_z = normal.z >= 0.0 ? 1.0 : -1.0;
	float a = -1.0 / (sign_z + normal.z);
	float b = normal.x * normal.y * a;
	vec3 across = vec3(1.0 + sign_z * normal.x * normal.x * a, sign_z * b, -sign_z * normal.x);
	vec3 along = vec3(b, sign_z + normal.y * normal.y * a, -normal.y);
	float angle = 6.283185307 * at.x, radius = sqrt(at.y);
	return across * (radius * cos(angle)) + along * (radius * sin(angle)) + normal * sqrt(max(0.0, 1.0 - at.y));
}

#endif
