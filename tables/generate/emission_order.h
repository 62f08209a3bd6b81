// The order in which a pattern's triangles are emitted.
#pragma once
#include <cstdint>
#include <vector>

namespace tessera::generate
{

// Orders triangles (i | j << 8 | k << 16) so that few vertices are fetched again (countFetches): from each triangle that
// holds a corner, always to the one with most of its vertices still there, those soonest lost first. The best of these orders.
std::vector<uint32_t> orderForReuse(const std::vector<uint32_t>& triangles);

}  // namespace tessera::generate
