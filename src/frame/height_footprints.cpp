#include "frame/height_footprints.h"

#include "base/parallel.h"
#include "scene/build/height_map.h"
#include "shared/height.h"

#include <algorithm>

namespace tessera
{

namespace
{

// Of a footprint.
uint32_t wordsOf(uint32_t format)
{
	return format == HEIGHT_U8 ? 1 : format == HEIGHT_U16 ? 2 : 4;
}

uint32_t side(uint32_t size, uint32_t level)
{
	return std::max(size >> level, 1u);
}

uint64_t footprintsOf(const HeightMap& map, uint32_t level)
{
	return uint64_t(side(map.width, level) + FOOTPRINT_BORDER) * (side(map.height, level) + FOOTPRINT_BORDER);
}

// The bits of a texel, in the lowest.
uint32_t texelBits(const HeightMapData& map, uint32_t texel)
{
	if (map.record.format == HEIGHT_U8)
		return (map.texels[texel / 4] >> (texel % 4 * 8)) & 0xffu;
	if (map.record.format == HEIGHT_U16)
		return (map.texels[texel / 2] >> (texel % 2 * 16)) & 0xffffu;
	return map.texels[texel];
}

void packFootprint(uint32_t format, const uint32_t (&bits)[4], uint32_t* words)
{
	if (format == HEIGHT_U8)
		words[0] = bits[0] | bits[1] << 8 | bits[2] << 16 | bits[3] << 24;
	else if (format == HEIGHT_U16)
	{
		words[0] = bits[0] | bits[1] << 16;
		words[1] = bits[2] | bits[3] << 16;
	}
	else
		std::copy(std::begin(bits), std::end(bits), words);
}

// Row `row` of a level's footprints, those of texels (-2, row - 2) and on.
void packRow(const HeightMapData& map, uint32_t level, uint32_t row, uint32_t* words)
{
	const HeightMap& record = map.record;
	const uint32_t width = side(record.width, level), height = side(record.height, level);
	const uint32_t upper = record.level_first[level] + width * wrapTexel(int(row) - 2, height, record.wrap_v);
	const uint32_t lower = record.level_first[level] + width * wrapTexel(int(row) - 1, height, record.wrap_v);
	for (uint32_t column = 0; column < width + FOOTPRINT_BORDER; ++column, words += wordsOf(record.format))
	{
		const uint32_t left = wrapTexel(int(column) - 2, width, record.wrap_u);
		const uint32_t right = wrapTexel(int(column) - 1, width, record.wrap_u);
		packFootprint(record.format,
					  { texelBits(map, upper + left), texelBits(map, upper + right), texelBits(map, lower + left), texelBits(map, lower + right) },
					  words);
	}
}

}  // namespace

HeightFootprints heightFootprints(const HeightMapData& map)
{
	HeightFootprints result = { map.record, std::vector<uint32_t>(footprintBytes(map) / sizeof(uint32_t)) };
	uint64_t first = 0;
	for (uint32_t level = 0; level < map.record.level_count; ++level)
	{
		result.record.level_first[level] = uint32_t(first);
		const uint64_t row_words = uint64_t(side(map.record.width, level) + FOOTPRINT_BORDER) * wordsOf(map.record.format);
		uint32_t* words = result.texels.data() + first * wordsOf(map.record.format);
		parallelFor(side(map.record.height, level) + FOOTPRINT_BORDER,
					[&](size_t row) { packRow(map, level, uint32_t(row), words + row * row_words); });
		first += footprintsOf(map.record, level);
	}
	return result;
}

uint64_t footprintBytes(const HeightMapData& map)
{
	uint64_t footprints = 0;
	for (uint32_t level = 0; level < map.record.level_count; ++level)
		footprints += footprintsOf(map.record, level);
	return footprints * wordsOf(map.record.format) * sizeof(uint32_t);
}

}  // namespace tessera
