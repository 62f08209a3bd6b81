#include "report/sampling.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace tessera::report
{

namespace
{

constexpr size_t kHills = 32;         // samples from which each largest error is searched for
constexpr double kFirstStride = 0.2;  // of a triangle's weights
constexpr double kLastStride = 0.01;

double fraction(double x)
{
	return x - std::floor(x);
}

}  // namespace

dvec2 pointOfSequence(uint64_t i)
{
	constexpr double kG = 1.32471795724474602596;
	return { fraction(0.5 + double(i) / kG), fraction(0.5 + double(i) / (kG * kG)) };
}

dvec3 numbersOfSequence(uint64_t i)
{
	constexpr double kG = 1.22074408460575947536;
	return { fraction(0.5 + double(i) / kG), fraction(0.5 + double(i) / (kG * kG)), fraction(0.5 + double(i) / (kG * kG * kG)) };
}

dvec2 spreadOverTriangle(dvec2 numbers)
{
	return numbers.x + numbers.y > 1 ? dvec2(1) - numbers : numbers;
}

size_t pieceAt(const std::vector<double>& areas, double share)
{
	const auto found = std::upper_bound(areas.begin(), areas.end(), share * areas.back());
	return static_cast<size_t>(std::min(found, areas.end() - 1) - areas.begin());
}

double largestByClimbing(size_t count, const std::function<double(size_t)>& heightOf, const std::function<double(size_t)>& climbFrom)
{
	std::vector<std::pair<double, size_t>> order;
	order.reserve(count);
	for (size_t i = 0; i < count; ++i)
		order.emplace_back(-heightOf(i), i);
	const size_t hills = std::min(kHills, count);
	std::partial_sort(order.begin(), order.begin() + static_cast<ptrdiff_t>(hills), order.end());
	std::vector<double> heights(hills);
	parallelFor(hills, [&](size_t i) { heights[i] = climbFrom(order[i].second); });
	return hills == 0 ? 0 : *std::max_element(heights.begin(), heights.end());
}

double climb(dvec2 weights, double height, const std::function<std::optional<double>(dvec2 weights)>& heightAt)
{
	for (double stride = kFirstStride; stride > kLastStride;)
	{
		bool found = false;
		for (const dvec2 direction : { dvec2(1, 0), dvec2(0, 1), dvec2(1, -1), dvec2(-1, 0), dvec2(0, -1), dvec2(-1, 1) })
		{
			const dvec2 tried = weights + direction * stride;
			if (tried.x < 0 || tried.y < 0 || tried.x + tried.y > 1)
				continue;
			const std::optional<double> there = heightAt(tried);
			if (!there || !(*there > height))
				continue;
			height = *there;
			weights = tried;
			found = true;
			break;
		}
		stride = found ? stride : stride / 2;
	}
	return height;
}

}  // namespace tessera::report
