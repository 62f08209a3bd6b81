// Height maps as devices read them fastest: with each texel's neighbours beside it.
#pragma once
#include "scene/scene.h"

namespace tessera
{

// A height map whose `texels` are footprints (shared/height.h): for every level rows of width + FOOTPRINT_BORDER footprints, height +
// FOOTPRINT_BORDER of them, the first that of texel (-2, -2). A footprint is its texel, the right neighbour, and the two below, wrapped as the map
// says and packed in that order, lowest bits first: one word for 8-bit texels, two for 16-bit ones, four for floats.
struct HeightFootprints
{
	HeightMap record;              // as the map's, but for level_first, which counts footprints; texels = 0
	std::vector<uint32_t> texels;  // words
};

// Takes four times the map's memory and a little more. On all threads.
HeightFootprints heightFootprints(const HeightMapData& map);

// Bytes of heightFootprints(map).
uint64_t footprintBytes(const HeightMapData& map);

}  // namespace tessera
