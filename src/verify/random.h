// Random numbers that are the same on every platform for the same seed.
#pragma once
#include "base/vec.h"

#include <cmath>
#include <cstdint>

namespace tessera::verify
{

// Source: Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators (2014): SplitMix64.
class Random
{
public:
	explicit Random(uint64_t seed) : state_(seed) {}

	uint64_t bits()
	{
		uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
		z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ull;
		z = (z ^ z >> 27) * 0x94d049bb133111ebull;
		return z ^ z >> 31;
	}
	// [0, count), count above 0.
	uint32_t below(size_t count) { return static_cast<uint32_t>(bits() % count); }
	double between(double low, double high) { return low + (high - low) * double(bits() >> 11) * 0x1p-53; }
	// On the unit sphere.
	dvec3 direction()
	{
		const double z = between(-1, 1), angle = between(0, 6.283185307179586), r = std::sqrt(std::max(0.0, 1 - z * z));
		return { r * std::cos(angle), r * std::sin(angle), z };
	}

private:
	uint64_t state_;
};

}  // namespace tessera::verify
