#include "base/parallel.h"
#include "scene/build/height_map.h"
#include "shared/height.h"

#include <algorithm>
#include <cmath>

namespace tessera
{

namespace
{

// Rounding of an interpolated coordinate, of folding it and of scaling it by the map's size, relative to its magnitude and to 1.
constexpr double kCoordinateRounding = 5e-7;
// Rounding of decoding, two bilinear blends, the mip blend, factor and offset.
constexpr float kHeightRounding = 2e-6f;
// A footprint of up to this many cells per axis is read cell by cell.
constexpr uint32_t kMostCells = 8;

// Texels along one axis, as up to two closed intervals.
struct Spans
{
	uint32_t count = 0;
	uint32_t first[2];
	uint32_t last[2];

	void add(double a, double b)
	{
		first[count] = uint32_t(a);
		last[count] = uint32_t(b);
		++count;
	}
	bool whole(uint32_t size) const { return count == 1 && first[0] == 0 && last[0] == size - 1; }
};

// The texels that bilinear reads between two coordinates touch. `low` and `high` have their rounding added already.
Spans spansOf(double low, double high, uint32_t size, uint32_t wrap)
{
	double a = std::floor(low * size - 0.5);
	double b = std::floor(high * size - 0.5) + 1;
	Spans spans;
	const double most = size - 1.0;
	if (wrap == WRAP_CLAMP)
	{
		spans.add(std::clamp(a, 0.0, most), std::clamp(b, 0.0, most));
		return spans;
	}
	// Cover the line by tiles of the map; every second one is reflected when mirrored. A whole tile covers the map.
	if (!(b - a < most))
	{
		spans.add(0, most);
		return spans;
	}
	const double first_tile = std::floor(a / size);
	for (double tile = first_tile; tile <= first_tile + 1 && tile * size <= b; ++tile)
	{
		const double from = std::max(a - tile * size, 0.0);
		const double to = std::min(b - tile * size, most);
		const bool reflected = wrap == WRAP_MIRROR && std::fmod(tile, 2.0) != 0;
		reflected ? spans.add(most - to, most - from) : spans.add(from, to);
	}
	return spans;
}

}  // namespace

HeightRanges::HeightRanges(const HeightMapData& map) : map_(hostRecord(map))
{
	levels_.resize(map_.level_count);
	for (uint32_t level = 0; level < map_.level_count; ++level)
		levels_[level] = buildLevel(level);
	for (uint32_t level = map_.level_count; level-- > 0;)
	{
		Level& own = levels_[level];
		for (uint32_t y = 0; y < own.grids.back().height; ++y)
			for (uint32_t x = 0; x < own.grids.back().width; ++x)
				own.coarser.include(own.grids.back().cells[size_t(y) * own.grids.back().width + x]);
		if (level + 1 < map_.level_count)
			own.coarser.include(levels_[level + 1].coarser);
	}
}

HeightRanges::Level HeightRanges::buildLevel(uint32_t level) const
{
	Level result;
	result.width = std::max(map_.width >> level, 1u);
	result.height = std::max(map_.height >> level, 1u);
	uint32_t finer_width = result.width, finer_height = result.height;
	do
	{
		Grid grid;
		grid.width = (finer_width + 3) / 4;
		grid.height = (finer_height + 3) / 4;
		grid.cells.resize(size_t(grid.width) * grid.height);
		const Grid* finer = result.grids.empty() ? nullptr : &result.grids.back();
		parallelFor(grid.height >= 64 ? grid.height : 1, [&](size_t row) {
			const uint32_t first_row = grid.height >= 64 ? uint32_t(row) : 0, last_row = grid.height >= 64 ? uint32_t(row) : grid.height - 1;
			for (uint32_t y = 4 * first_row; y < std::min(4 * last_row + 4, finer_height); ++y)
				for (uint32_t x = 0; x < finer_width; ++x)
				{
					Interval& cell = grid.cells[size_t(y / 4) * grid.width + x / 4];
					if (finer)
						cell.include(finer->cells[size_t(y) * finer_width + x]);
					else
						cell.include(texelHeight(map_, map_.level_first[level] + y * finer_width + x));
				}
		});
		finer_width = grid.width;
		finer_height = grid.height;
		result.grids.push_back(std::move(grid));
	} while (finer_width > kMostCells || finer_height > kMostCells);
	return result;
}

Interval HeightRanges::cellsOver(uint32_t level, uint32_t first_x, uint32_t last_x, uint32_t first_y, uint32_t last_y) const
{
	const Level& own = levels_[level];
	Interval heights;
	size_t step = 0;
	while ((last_x >> (2 * step)) - (first_x >> (2 * step)) >= kMostCells || (last_y >> (2 * step)) - (first_y >> (2 * step)) >= kMostCells)
		++step;
	for (uint32_t y = first_y >> (2 * step); y <= last_y >> (2 * step); ++y)
		for (uint32_t x = first_x >> (2 * step); x <= last_x >> (2 * step); ++x)
			if (step == 0)
				heights.include(texelHeight(map_, map_.level_first[level] + y * own.width + x));
			else
				heights.include(own.grids[step - 1].cells[size_t(y) * own.grids[step - 1].width + x]);
	return heights;
}

Interval HeightRanges::over(vec2 low, vec2 high, uint32_t mips) const
{
	const double pad_u = kCoordinateRounding * (1 + std::max(std::fabs(double(low.x)), std::fabs(double(high.x))));
	const double pad_v = kCoordinateRounding * (1 + std::max(std::fabs(double(low.y)), std::fabs(double(high.y))));
	Interval heights;
	for (uint32_t level = 0; level < std::min(map_.level_count, mips); ++level)
	{
		const Level& own = levels_[level];
		const Spans columns = spansOf(low.x - pad_u, high.x + pad_u, own.width, map_.wrap_u);
		const Spans rows = spansOf(low.y - pad_v, high.y + pad_v, own.height, map_.wrap_v);
		// The whole map here: coarser levels cannot give less than all of theirs.
		if (columns.whole(own.width) && rows.whole(own.height))
		{
			heights.include(own.coarser);
			return heights;
		}
		for (uint32_t row = 0; row < rows.count; ++row)
			for (uint32_t column = 0; column < columns.count; ++column)
				heights.include(cellsOver(level, columns.first[column], columns.last[column], rows.first[row], rows.last[row]));
	}
	return heights;
}

Interval HeightRanges::displacement(Interval heights) const
{
	Interval result;
	result.include(heights.low * map_.factor + map_.offset);
	result.include(heights.high * map_.factor + map_.offset);
	const float largest = std::max(std::fabs(heights.low), std::fabs(heights.high));
	const float rounding = (largest * std::fabs(map_.factor) + std::fabs(map_.offset)) * kHeightRounding;
	result.low -= rounding;
	result.high += rounding;
	return result;
}

}  // namespace tessera
