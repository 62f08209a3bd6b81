// Disjoint sets of 0..count-1, joined pair by pair.
#pragma once
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace tessera
{

// A set's root is its lowest member.
class DisjointSets
{
public:
	explicit DisjointSets(size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }

	uint32_t root(uint32_t member)
	{
		while (parents_[member] != member)
			member = parents_[member] = parents_[parents_[member]];
		return member;
	}

	void unite(uint32_t a, uint32_t b)
	{
		a = root(a);
		b = root(b);
		parents_[std::max(a, b)] = std::min(a, b);
	}

private:
	std::vector<uint32_t> parents_;
};

}  // namespace tessera
