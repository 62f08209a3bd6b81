// Height maps: mips, box-filtered by us (DESIGN.md, section 7), packed as shared/height.h reads them.
#pragma once
#include "scene/scene.h"

namespace tessera
{

// True when the displacement is 0 everywhere, so that nothing needs to be displaced: factor and offset 0, or a constant map that
// comes to 0.
bool displacesByNothing(const Image& image, float factor, float offset);

// The red channel of `image` with all its mips down to 1 x 1. Level sizes halve, rounded down (at least 1); a texel is the mean of the
// area that it covers on the level before (odd sizes: fractional weights), in double; integer formats keep their format and round
// to nearest. Float texels that are not finite or are below 2^-60 become 0. Linear in the texels, on all threads.
HeightMapData buildHeightMap(const Image& image, const Texture& texture, float factor, float offset);

// The record with the address of the host's own texels: what the CPU evaluates.
HeightMap hostRecord(const HeightMapData& map);

// Closed interval; empty while low > high.
struct Interval
{
	float low = std::numeric_limits<float>::infinity();
	float high = -std::numeric_limits<float>::infinity();

	void include(float value)
	{
		low = value < low ? value : low;
		high = value > high ? value : high;
	}
	void include(Interval other)
	{
		low = other.low < low ? other.low : low;
		high = other.high > high ? other.high : high;
	}
};

// Answers what heights a rectangle of the map can give, from pyramids of smallest and largest texels per mip.
class HeightRanges
{
public:
	explicit HeightRanges(const HeightMapData& map);

	// Hull of every texel, of every mip, that a bilinear read anywhere in [low, high] (texture coordinates, any magnitude) touches:
	// wraps are followed, the float rounding of interpolated coordinates is allowed for. A footprint of up to 8 x 8 texels of a mip
	// is read exactly; a larger one is rounded outwards to cells of at most half its size. A few dozen reads per mip. `mips`: only
	// the finest so many.
	Interval over(vec2 low, vec2 high, uint32_t mips = MAX_HEIGHT_LEVELS) const;

	// The displacement interval of `heights`, rounding of the evaluation included. Mesh units at scale 1.
	Interval displacement(Interval heights) const;

private:
	// Cells of 4^step x 4^step texels of one mip.
	struct Grid
	{
		uint32_t width = 0, height = 0;
		std::vector<Interval> cells;
	};
	struct Level
	{
		uint32_t width = 0, height = 0;
		std::vector<Grid> grids;  // step 1, 2, ...
		Interval coarser;         // of this and all coarser levels
	};

	Level buildLevel(uint32_t level) const;
	Interval cellsOver(uint32_t level, uint32_t first_x, uint32_t last_x, uint32_t first_y, uint32_t last_y) const;

	HeightMap map_;
	std::vector<Level> levels_;
};

}  // namespace tessera
