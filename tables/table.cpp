#include "tables/table.h"

#include "base/check.h"

namespace tessera
{

std::vector<std::array<uint32_t, 3>> configFactors(uint32_t max_edge_segments)
{
	std::vector<std::array<uint32_t, 3>> factors;
	factors.reserve(configCount(max_edge_segments));
	for (uint32_t a = 1; a <= max_edge_segments; a++)
	{
		for (uint32_t b = 1; b <= a; b++)
		{
			for (uint32_t c = 1; c <= b; c++)
				factors.push_back({ a, b, c });
		}
	}
	return factors;
}

PatternUse usePattern(uint32_t f01, uint32_t f12, uint32_t f20)
{
	static constexpr std::array<std::array<uint8_t, 3>, 6> kOrders = {
		{ { 0, 1, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 1, 0, 2 }, { 0, 2, 1 }, { 2, 1, 0 } }
	};
	CHECK(f01 >= 1 && f12 >= 1 && f20 >= 1, "factors ({}, {}, {}) start at 1", f01, f12, f20);
	// The factor of the edge between corners i and j, found by the third corner, 3 - i - j.
	const std::array<uint32_t, 3> opposite = { f12, f20, f01 };
	for (uint32_t i = 0; i < kOrders.size(); i++)
	{
		const uint32_t a = opposite[kOrders[i][2]];
		const uint32_t b = opposite[kOrders[i][0]];
		const uint32_t c = opposite[kOrders[i][1]];
		if (a >= b && b >= c)
			return { configIndex(a, b, c), kOrders[i], i >= 3 };
	}
	checkFailed(__FILE__, __LINE__, "sorted", "three factors always have a sorted order");
}

}  // namespace tessera
