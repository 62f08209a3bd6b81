// Hashes and noises that the built-in scenes are made of.
// Only integer arithmetic and float add, subtract, multiply, divide and square root: the same bits on every platform and compiler.
// No function here calls the maths library for anything that is not exactly rounded.
#pragma once
#include "base/vec.h"

#include <cstdint>

namespace tessera::builtin
{

// Mixes the bits of x: a good 32-bit hash, and a bijection.
constexpr uint32_t mixBits(uint32_t x)
{
	x ^= x >> 16;
	x *= 0x7feb352du;
	x ^= x >> 15;
	x *= 0x846ca68bu;
	x ^= x >> 16;
	return x;
}

inline constexpr uint32_t kHashX = 0x8da6b343u, kHashY = 0xd8163841u, kHashZ = 0xcb1ab31fu, kHashSeed = 0x9e3779b9u;

constexpr uint32_t hashLattice(ivec3 cell, uint32_t seed)
{
	return mixBits((uint32_t(cell.x) * kHashX) ^ (uint32_t(cell.y) * kHashY) ^ (uint32_t(cell.z) * kHashZ) ^ (seed * kHashSeed));
}

// The top 24 bits of a hash as a number in [0, 1).
constexpr float unitFloat(uint32_t hash)
{
	return float(hash >> 8) * (1.0f / 16777216.0f);
}

// A stream of random numbers.
class Random
{
public:
	explicit Random(uint32_t seed) : state_(mixBits(seed)) {}
	float next() { return unitFloat(mixBits(state_ += 0x9e3779b9u)); }         // [0, 1)
	float next(float low, float high) { return low + (high - low) * next(); }  // [low, high)
	vec3 direction();                                                          // unit length, uniform over the sphere

private:
	uint32_t state_;
};

// The largest integer <= x, for |x| < 2^31 (std::floor is a library call on plain x86-64).
inline int floorToInt(float x)
{
	const int truncated = int(x);
	return truncated - int(x < float(truncated));
}

// Hermite step from 0 at `low` to 1 at `high`; low > high steps down.
inline float smoothStep(float low, float high, float x)
{
	const float t = glm::clamp((x - low) / (high - low), 0.0f, 1.0f);
	return t * t * (3.0f - 2.0f * t);
}

// Sine of `turns` full turns (|turns| < 2^20), error below 1e-7: a polynomial, since libraries differ in the last bit.
double sineOfTurns(double turns);
inline double cosineOfTurns(double turns)
{
	return sineOfTurns(turns + 0.25);
}

// Gradient noise, roughly within [-1, 1], zero at lattice points.
float gradientNoise(vec3 p, uint32_t seed);

// Value (x) and gradient (y, z) of 2D value noise within [-1, 1]; the lattice repeats after `period` cells (0: never).
vec3 valueNoiseWithGradient(vec2 p, uint32_t seed, int period = 0);

// Sums of `octaves` gradient noises, each twice as fine and half as high, roughly within [-1, 1].
float fractalNoise(vec3 p, int octaves, uint32_t seed);

// Ridged multifractal within [0, 1]: sharp crests whose detail gathers on the crests. Source: Musgrave, "Texturing and Modeling", chapter 16.
float ridgedNoise(vec3 p, int octaves, uint32_t seed);

// Fractal noise whose octaves are held back where the slope is steep, as if worn by water; within about [-1, 1].
float erodedNoise(vec2 p, int octaves, uint32_t seed);

// Tileable fractal value noise within [-1, 1] over the unit square; `cells` lattice cells across in the first octave.
float tileableNoise(vec2 uv, int cells, int octaves, uint32_t seed);

// Cells around jittered points, tileable over the unit square.
struct CellPoint
{
	float nearest = 0;       // distance to the nearest point, in cells
	float border = 0;        // distance to the border with the neighbouring cell, in cells
	uint32_t cell_hash = 0;  // of the nearest point's cell
	vec2 offset = { 0, 0 };  // from the nearest point, in cells
};
CellPoint tileableCells(vec2 uv, int cells, uint32_t seed);

}  // namespace tessera::builtin
