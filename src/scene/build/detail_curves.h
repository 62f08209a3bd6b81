// One base triangle's share of the tables of edge_detail.h: how far its displaced surface lies from uniform tessellations of it.
#pragma once
#include "base/vec.h"

#include <array>
#include <cstdint>
#include <functional>

namespace tessera
{

// A curve of shared/edge_detail.h before the scene's bias is known: log2 of mesh units in 1/8, rounded up; never rising.
struct DetailCurve
{
	static constexpr int kNone = -16384;  // no deviation at all

	std::array<int, 8> codes = { kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone };

	// The larger of the two.
	void include(const DetailCurve& other);
};

constexpr uint32_t kLeastSamplesLevel = 3, kMostSamplesLevel = 12;

// Samples of a triangle at this level: 2^level steps per edge.
constexpr uint64_t sampleCount(uint32_t level)
{
	return ((uint64_t(1) << level) + 1) * ((uint64_t(1) << level) + 2) / 2;
}

// `samples_level`: kLeastSamplesLevel to kMostSamplesLevel. `position`: the displaced surface (i, j) of 2^samples_level steps from corner 2 to
// corners 0 and 1. Codes of lengths that are finer than the samples fall by an octave each, as a creased surface's do. Time: sampleCount x 8 steps;
// memory 12 bytes a sample.
DetailCurve measureCurve(uint32_t samples_level, const std::function<vec3(uint32_t i, uint32_t j)>& position);

}  // namespace tessera
