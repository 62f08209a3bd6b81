// What measuring by samples has in common: points spread evenly, when figures are steady, and the way uphill to the largest error.
#pragma once
#include "base/vec.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace tessera::report
{

struct SamplingLimits
{
	uint64_t first = uint64_t(1) << 15;
	uint64_t most = uint64_t(1) << 20;
	double change = 0.01;
};

inline constexpr uint64_t kSampleChunk = 1024;  // samples per piece of parallel work
// Below these an error is what floats leave.
inline constexpr double kLeastPx = 1e-3;
inline constexpr double kLeastRelative = 1e-7;  // of the diagonal

// Point i of a low-discrepancy sequence of the unit square, or cube. Source: Roberts, The Unreasonable Effectiveness of Quasirandom Sequences.
dvec2 pointOfSequence(uint64_t i);
dvec3 numbersOfSequence(uint64_t i);

// Spreads two numbers of 0..1 evenly over a triangle: weights of its first two corners.
dvec2 spreadOverTriangle(dvec2 numbers);

// Which of the pieces whose areas, summed up to and with each, are `areas` lies at `share` (0..1) of the whole. `areas` is not empty.
size_t pieceAt(const std::vector<double>& areas, double share);

// The largest of up to 32 climbs from the largest of `count` samples: heightOf(i) is that of sample i, climbFrom(i) the height that is reached from
// it (at least its own; asked for on all threads). 0 without samples.
double largestByClimbing(size_t count, const std::function<double(size_t)>& heightOf, const std::function<double(size_t)>& climbFrom);

// The largest height that steps of shrinking length lead to within a triangle, from `weights`, whose height is `height`. No step goes where
// heightAt gives none.
double climb(dvec2 weights, double height, const std::function<std::optional<double>(dvec2 weights)>& heightAt);

}  // namespace tessera::report
