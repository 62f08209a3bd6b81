// Colours of debug views: hashes of identities, never of list indices, so that frames and devices agree (contract C4).
#ifndef TESSERA_LIB_DEBUG_COLORS
#define TESSERA_LIB_DEBUG_COLORS
#include "lib/visible_triangle.glsl"

// One round of a multiplicative hash with xor shifts (Mueller's finaliser).
uint hashNext(uint seed, uint value)
{
	uint h = seed ^ value;
	h = (h ^ (h >> 16)) * 0x45d9f3bu;
	h = (h ^ (h >> 16)) * 0x45d9f3bu;
	return (h ^ (h >> 16)) + 0x9e3779b9u;
}

// A colour of even brightness: hue from the hash, some spread of value.
vec3 hashColor(uint hash)
{
	float hue = float(hash & 0xffffu) / 65536.0;
	float value = 0.45 + 0.45 * float((hash >> 16) & 0xffu) / 255.0;
	vec3 rgb = clamp(abs(fract(hue + vec3(0.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
	return mix(vec3(1.0), rgb, 0.65) * value;
}

uint clusterHash(VisibleTriangle visible) { return hashNext(hashNext(17u, visible.instance), visible.cluster); }

uint partHash(VisibleTriangle visible)
{
	uint hash = hashNext(clusterHash(visible), visible.triangle);
	hash = hashNext(hashNext(hash, visible.piece.c0.u), visible.piece.c0.v);
	hash = hashNext(hashNext(hash, visible.piece.c1.u), visible.piece.c1.v);
	return hashNext(hashNext(hash, visible.piece.c2.u), visible.piece.c2.v);
}

uint microHash(VisibleTriangle visible) { return hashNext(partHash(visible), visible.micro + 1u); }

// Dark blue over green and yellow to red for 0..1.
vec3 ramp(float t)
{
	t = clamp(t, 0.0, 1.0);
	vec3 low = mix(vec3(0.06, 0.10, 0.45), vec3(0.05, 0.55, 0.55), clamp(t * 3.0, 0.0, 1.0));
	vec3 middle = mix(low, vec3(0.85, 0.80, 0.15), clamp(t * 3.0 - 1.0, 0.0, 1.0));
	return mix(middle, vec3(0.80, 0.08, 0.05), clamp(t * 3.0 - 2.0, 0.0, 1.0));
}

#endif
