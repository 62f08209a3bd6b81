#include "tables/generate/emission_order.h"

#include "tables/table_quality.h"

#include <limits>

namespace tessera::generate
{

// The vertices fetched last, as countFetches counts them.
class FetchWindow
{
public:
	void fetch(uint32_t triangle)
	{
		for (uint32_t i = 0; i < 3; i++)
		{
			const uint32_t vertex = triangle >> (8 * i) & 0xff;
			if (!holds(vertex))
				fetched_at_[vertex] = ++fetches_;
		}
	}
	// Higher is better: vertices held first, then how soon they are lost.
	uint32_t score(uint32_t triangle) const
	{
		uint32_t score = 0;
		for (uint32_t i = 0; i < 3; i++)
		{
			const uint32_t vertex = triangle >> (8 * i) & 0xff;
			if (holds(vertex))
				score += 1000 + fetches_ - fetched_at_[vertex];
		}
		return score;
	}
	uint32_t fetches() const { return fetches_; }

private:
	bool holds(uint32_t vertex) const { return fetched_at_[vertex] != 0 && fetches_ - (fetched_at_[vertex] - 1) <= kReuseWindow; }

	std::array<uint32_t, 256> fetched_at_ = {};
	uint32_t fetches_ = 0;
};

static std::vector<uint32_t> orderFrom(std::vector<uint32_t> left, size_t start)
{
	FetchWindow window;
	std::vector<uint32_t> order;
	for (size_t next = start; !left.empty();)
	{
		order.push_back(left[next]);
		window.fetch(left[next]);
		left.erase(left.begin() + std::ptrdiff_t(next));
		uint32_t best_score = 0;
		next = 0;
		for (size_t i = 0; i < left.size(); i++)
		{
			if (window.score(left[i]) > best_score)
			{
				best_score = window.score(left[i]);
				next = i;
			}
		}
	}
	return order;
}

std::vector<uint32_t> orderForReuse(const std::vector<uint32_t>& triangles)
{
	std::vector<uint32_t> best;
	uint32_t best_fetches = std::numeric_limits<uint32_t>::max();
	for (size_t start = 0; start < triangles.size(); start++)
	{
		const uint32_t t = triangles[start];
		const bool has_corner = (t & 0xff) < 3 || (t >> 8 & 0xff) < 3 || (t >> 16 & 0xff) < 3;
		if (!has_corner)
			continue;
		const std::vector<uint32_t> order = orderFrom(triangles, start);
		if (countFetches(order) < best_fetches)
		{
			best_fetches = countFetches(order);
			best = order;
		}
	}
	return best;
}

}  // namespace tessera::generate
