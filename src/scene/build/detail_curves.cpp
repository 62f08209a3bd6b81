#include "scene/build/detail_curves.h"

#include "base/check.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tessera
{

namespace
{

// The surface over a base triangle, and its distance from flat pieces. A piece up (i, j) has corners (i, j), (i + 1, j), (i, j + 1); down (i, j) has
// (i + 1, j), (i, j + 1), (i + 1, j + 1), in its own steps.
class Samples
{
public:
	Samples(uint32_t level, const std::function<vec3(uint32_t, uint32_t)>& position) : side_(1u << level), points_(sampleCount(level))
	{
		for (uint32_t j = 0; j <= side_; ++j)
			for (uint32_t i = 0; i + j <= side_; ++i)
				points_[place(i, j)] = position(i, j);
	}

	// Largest distance of the surface from the planes of the pieces of `pieces` segments per edge.
	float deviation(uint32_t pieces) const
	{
		const uint32_t size = side_ / pieces;
		float largest = 0;
		for (uint32_t j = 0; j < pieces; ++j)
			for (uint32_t i = 0; i + j < pieces; ++i)
			{
				largest = std::max(largest, farthest(i * size, j * size, size, false));
				if (i + j + 1 < pieces)
					largest = std::max(largest, farthest(i * size, j * size, size, true));
			}
		return largest;
	}

private:
	size_t place(uint32_t i, uint32_t j) const { return size_t(j) * (side_ + 1) - size_t(j) * (j + 1) / 2 + j + i; }

	// Of the samples in a piece, borders included, from its plane; where it has none, from a corner.
	float farthest(uint32_t i, uint32_t j, uint32_t size, bool down) const
	{
		const vec3 p = points_[place(i + size, j)], q = points_[place(i, j + size)];
		const vec3 r = down ? points_[place(i + size, j + size)] : points_[place(i, j)];
		const dvec3 across = glm::cross(dvec3(p) - dvec3(r), dvec3(q) - dvec3(r));
		const double length = glm::length(across);
		const vec3 normal = length > 0 ? vec3(across / length) : vec3(0);
		float largest = 0;
		for (uint32_t b = 0; b <= size; ++b)
		{
			const uint32_t begin = down ? size - b : 0, end = down ? size : size - b;
			const vec3* row = &points_[place(i, j + b)];
			for (uint32_t a = begin; a <= end; ++a)
			{
				const vec3 from = row[a] - r;
				largest = std::max(largest, length > 0 ? std::fabs(glm::dot(normal, from)) : glm::length(from));
			}
		}
		return largest;
	}

	uint32_t side_;
	std::vector<vec3> points_;
};

int codeOf(float deviation)
{
	return deviation > 0 ? int(std::ceil(8 * std::log2(double(std::min(deviation, 1e30f))))) : DetailCurve::kNone;
}

}  // namespace

void DetailCurve::include(const DetailCurve& other)
{
	for (size_t i = 0; i < codes.size(); ++i)
		codes[i] = std::max(codes[i], other.codes[i]);
}

DetailCurve measureCurve(uint32_t samples_level, const std::function<vec3(uint32_t i, uint32_t j)>& position)
{
	CHECK(samples_level >= kLeastSamplesLevel && samples_level <= kMostSamplesLevel, "samples of level {}", samples_level);
	const Samples samples(samples_level, position);
	DetailCurve curve;
	for (uint32_t i = 0; i < curve.codes.size(); ++i)
		curve.codes[i] = i < samples_level ? codeOf(samples.deviation(1u << i)) : std::max(curve.codes[i - 1] - 8, DetailCurve::kNone);
	for (size_t i = curve.codes.size() - 1; i-- > 0;)
		curve.codes[i] = std::max(curve.codes[i], curve.codes[i + 1]);
	return curve;
}

}  // namespace tessera
