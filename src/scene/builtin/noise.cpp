#include "scene/builtin/noise.h"

#include <algorithm>
#include <cmath>

namespace tessera::builtin
{

vec3 Random::direction()
{
	for (;;)
	{
		const vec3 p = { next(-1, 1), next(-1, 1), next(-1, 1) };
		const float squared = glm::dot(p, p);
		if (squared > 0.01f && squared < 1.0f)
			return p / std::sqrt(squared);
	}
}

double sineOfTurns(double turns)
{
	// Fold into [-1/4, 1/4] turns, where the series converges fast.
	turns -= double(int64_t(turns));
	turns -= double(int(turns > 0.5)) - double(int(turns < -0.5));
	if (turns > 0.25)
		turns = 0.5 - turns;
	if (turns < -0.25)
		turns = -0.5 - turns;
	const double x = turns * 6.283185307179586;
	const double xx = x * x;
	return x * (1 - xx / 6 * (1 - xx / 20 * (1 - xx / 42 * (1 - xx / 72 * (1 - xx / 110 * (1 - xx / 156))))));
}

static float fade(float t)
{
	return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

static float fadeSlope(float t)
{
	return 30.0f * t * t * (t * (t - 2.0f) + 1.0f);
}

static float mixed(float a, float b, float t)
{
	return a + (b - a) * t;
}

// The random gradient of a lattice point, times the way from there.
static inline float gradientTerm(uint32_t x_y_z, float x, float y, float z)
{
	constexpr float kScale = 1.0f / 511.5f;
	const uint32_t hash = mixBits(x_y_z);
	const float gx = float(int(hash & 1023u)) * kScale - 1.0f;
	const float gy = float(int((hash >> 10) & 1023u)) * kScale - 1.0f;
	const float gz = float(int((hash >> 20) & 1023u)) * kScale - 1.0f;
	return gx * x + gy * y + gz * z;
}

float gradientNoise(vec3 p, uint32_t seed)
{
	const int x = floorToInt(p.x), y = floorToInt(p.y), z = floorToInt(p.z);
	const float x0 = p.x - float(x), y0 = p.y - float(y), z0 = p.z - float(z);
	const float x1 = x0 - 1.0f, y1 = y0 - 1.0f, z1 = z0 - 1.0f;
	// hashLattice of the eight corners, sharing its products.
	const uint32_t hx0 = uint32_t(x) * kHashX, hy0 = uint32_t(y) * kHashY, hz0 = (uint32_t(z) * kHashZ) ^ (seed * kHashSeed);
	const uint32_t hx1 = uint32_t(x + 1) * kHashX, hy1 = uint32_t(y + 1) * kHashY, hz1 = (uint32_t(z + 1) * kHashZ) ^ (seed * kHashSeed);
	const float u = fade(x0), v = fade(y0), w = fade(z0);
	const float a = mixed(gradientTerm(hx0 ^ hy0 ^ hz0, x0, y0, z0), gradientTerm(hx1 ^ hy0 ^ hz0, x1, y0, z0), u);
	const float b = mixed(gradientTerm(hx0 ^ hy1 ^ hz0, x0, y1, z0), gradientTerm(hx1 ^ hy1 ^ hz0, x1, y1, z0), u);
	const float c = mixed(gradientTerm(hx0 ^ hy0 ^ hz1, x0, y0, z1), gradientTerm(hx1 ^ hy0 ^ hz1, x1, y0, z1), u);
	const float d = mixed(gradientTerm(hx0 ^ hy1 ^ hz1, x0, y1, z1), gradientTerm(hx1 ^ hy1 ^ hz1, x1, y1, z1), u);
	return 1.2f * mixed(mixed(a, b, v), mixed(c, d, v), w);
}

static int wrapped(int i, int period)
{
	if (period == 0)
		return i;
	const int rest = i % period;
	return rest < 0 ? rest + period : rest;
}

vec3 valueNoiseWithGradient(vec2 p, uint32_t seed, int period)
{
	const int x0 = floorToInt(p.x), y0 = floorToInt(p.y);
	const vec2 f = p - vec2(float(x0), float(y0));
	const int xa = wrapped(x0, period), xb = wrapped(x0 + 1, period);
	const int ya = wrapped(y0, period), yb = wrapped(y0 + 1, period);
	const auto value = [&](int x, int y) {
		return unitFloat(hashLattice({ x, y, 0 }, seed)) * 2.0f - 1.0f;
	};
	const float a = value(xa, ya), b = value(xb, ya), c = value(xa, yb), d = value(xb, yb);
	const float u = fade(f.x), v = fade(f.y);
	const float twist = a - b - c + d;
	return { a + (b - a) * u + (c - a) * v + twist * u * v, fadeSlope(f.x) * (b - a + twist * v), fadeSlope(f.y) * (c - a + twist * u) };
}

// The next octave's place: turned, so that the lattices of two octaves don't line up, and `finer` times as fine.
static vec3 nextOctave(vec3 p, float finer)
{
	const vec3 turned = { 0.80f * p.y + 0.60f * p.z, -0.80f * p.x + 0.36f * p.y - 0.48f * p.z, -0.60f * p.x - 0.48f * p.y + 0.64f * p.z };
	return turned * finer + vec3(11.7f, 5.3f, 7.9f);
}

float fractalNoise(vec3 p, int octaves, uint32_t seed)
{
	float sum = 0, amplitude = 0.55f;
	for (int i = 0; i < octaves; ++i)
	{
		sum += amplitude * gradientNoise(p, seed + uint32_t(i));
		amplitude *= 0.5f;
		p = nextOctave(p, 2.03f);
	}
	return sum;
}

float ridgedNoise(vec3 p, int octaves, uint32_t seed)
{
	float sum = 0, amplitude = 0.5f, weight = 1;
	for (int i = 0; i < octaves; ++i)
	{
		const float noise = gradientNoise(p, seed + uint32_t(i));
		float crest = 1.0f - std::min(1.0f, 1.25f * (noise < 0 ? -noise : noise));
		crest *= crest * weight;
		weight = glm::clamp(crest * 1.9f, 0.0f, 1.0f);
		sum += amplitude * crest;
		amplitude *= 0.52f;
		p = nextOctave(p, 2.07f);
	}
	return sum;
}

float erodedNoise(vec2 p, int octaves, uint32_t seed)
{
	// Turns by 36.87 degrees between octaves, so that lattices don't line up.
	float sum = 0, amplitude = 0.5f;
	vec2 slope = { 0, 0 };
	for (int i = 0; i < octaves; ++i)
	{
		const vec3 noise = valueNoiseWithGradient(p, seed + uint32_t(i));
		slope += vec2(noise.y, noise.z);
		sum += amplitude * noise.x / (1.0f + glm::dot(slope, slope));
		amplitude *= 0.5f;
		p = vec2(1.6f * p.x - 1.2f * p.y, 1.2f * p.x + 1.6f * p.y);
	}
	return sum;
}

float tileableNoise(vec2 uv, int cells, int octaves, uint32_t seed)
{
	float sum = 0, amplitude = 0.5f;
	for (int i = 0; i < octaves; ++i)
	{
		sum += amplitude * valueNoiseWithGradient(uv * float(cells), seed + uint32_t(i), cells).x;
		amplitude *= 0.5f;
		cells *= 2;
	}
	return sum;
}

CellPoint tileableCells(vec2 uv, int cells, uint32_t seed)
{
	const vec2 p = uv * float(cells);
	const int x0 = floorToInt(p.x), y0 = floorToInt(p.y);
	vec2 points[25];
	uint32_t hashes[25];
	int nearest = 0;
	float nearest_squared = 100;
	for (int i = 0; i < 25; ++i)
	{
		const int x = x0 + i % 5 - 2, y = y0 + i / 5 - 2;
		hashes[i] = hashLattice({ wrapped(x, cells), wrapped(y, cells), 0 }, seed);
		const vec2 jitter = { unitFloat(hashes[i]), unitFloat(mixBits(hashes[i])) };
		points[i] = vec2(float(x), float(y)) + 0.15f + 0.7f * jitter;
		const vec2 way = p - points[i];
		const float squared = glm::dot(way, way);
		if (squared < nearest_squared)
		{
			nearest_squared = squared;
			nearest = i;
		}
	}
	float border = 100;
	for (int i = 0; i < 25; ++i)
	{
		if (i == nearest)
			continue;
		const vec2 across = points[i] - points[nearest];
		const vec2 from_middle = p - 0.5f * (points[i] + points[nearest]);
		border = std::min(border, -glm::dot(from_middle, across) / std::sqrt(glm::dot(across, across)));
	}
	return { std::sqrt(nearest_squared), border, hashes[nearest], p - points[nearest] };
}

}  // namespace tessera::builtin
