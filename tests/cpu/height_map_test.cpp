// Height maps: mips are area means, packing is what the shared reader reads, ranges contain all reads and little else.
#include "build_test_scenes.h"
#include "scene/build/height_map.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace tessera::test
{

namespace
{

uint32_t levelWidth(const HeightMapData& map, uint32_t level)
{
	return std::max(map.record.width >> level, 1u);
}

uint32_t levelHeight(const HeightMapData& map, uint32_t level)
{
	return std::max(map.record.height >> level, 1u);
}

float texel(const HeightMapData& map, uint32_t level, uint32_t x, uint32_t y)
{
	return texelHeight(hostRecord(map), map.record.level_first[level] + y * levelWidth(map, level) + x);
}

double mean(const HeightMapData& map, uint32_t level)
{
	double sum = 0;
	for (uint32_t y = 0; y < levelHeight(map, level); ++y)
		for (uint32_t x = 0; x < levelWidth(map, level); ++x)
			sum += texel(map, level, x, y);
	return sum / (double(levelWidth(map, level)) * levelHeight(map, level));
}

// The mean of a level over the area of one texel of the next, by overlap with every texel.
double areaMean(const HeightMapData& map, uint32_t level, uint32_t x, uint32_t y)
{
	const auto overlap = [](double a, double b, double c, double d) {
		return std::max(0.0, std::min(b, d) - std::max(a, c));
	};
	const uint32_t width = levelWidth(map, level), height = levelHeight(map, level);
	const double scale_x = double(width) / levelWidth(map, level + 1), scale_y = double(height) / levelHeight(map, level + 1);
	double sum = 0, weight = 0;
	for (uint32_t j = 0; j < height; ++j)
		for (uint32_t i = 0; i < width; ++i)
		{
			const double area = overlap(i, i + 1.0, x * scale_x, (x + 1) * scale_x) * overlap(j, j + 1.0, y * scale_y, (y + 1) * scale_y);
			sum += area * texel(map, level, i, j);
			weight += area;
		}
	return sum / weight;
}

HeightMapData mapOf(const Image& image, Wrap wrap = Wrap::Repeat)
{
	Texture texture;
	texture.wrap_u = texture.wrap_v = wrap;
	return buildHeightMap(image, texture, 1, 0);
}

const uvec2 kSizes[] = { { 1, 1 }, { 2, 2 }, { 3, 3 }, { 1, 7 }, { 5, 3 }, { 16, 16 }, { 33, 20 }, { 61, 47 }, { 100, 1 }, { 129, 255 } };

}  // namespace

TEST(heightMap, everyTexelOfAMipIsTheMeanOfTheAreaItCovers)
{
	for (const uvec2 size : kSizes)
	{
		const HeightMapData map = mapOf(noiseImage(size.x, size.y, TexelFormat::F32, 1));
		for (uint32_t level = 0; level + 1 < map.record.level_count; ++level)
			for (uint32_t y = 0; y < levelHeight(map, level + 1); ++y)
				for (uint32_t x = 0; x < levelWidth(map, level + 1); ++x)
					EXPECT_NEAR(texel(map, level + 1, x, y), areaMean(map, level, x, y), 1e-6) << size.x << " x " << size.y << " level " << level;
	}
}

TEST(heightMap, allMipsHaveTheMeanOfTheImage)
{
	for (const uvec2 size : kSizes)
		for (const TexelFormat format : { TexelFormat::U8, TexelFormat::U16, TexelFormat::F32 })
		{
			const HeightMapData map = mapOf(noiseImage(size.x, size.y, format, 2));
			const double rounding = format == TexelFormat::U8 ? 0.51 / 255 : format == TexelFormat::U16 ? 0.51 / 65535 : 1e-6;
			for (uint32_t level = 1; level < map.record.level_count; ++level)
				EXPECT_NEAR(mean(map, level), mean(map, 0), rounding);
		}
}

TEST(heightMap, theLastLevelIsOneTexelAndLevelsFollowEachOther)
{
	for (const uvec2 size : kSizes)
	{
		const HeightMapData map = mapOf(noiseImage(size.x, size.y, TexelFormat::U8, 3));
		uint32_t first = 0;
		for (uint32_t level = 0; level < map.record.level_count; ++level)
		{
			EXPECT_EQ(map.record.level_first[level], first);
			first += levelWidth(map, level) * levelHeight(map, level);
		}
		EXPECT_EQ(levelWidth(map, map.record.level_count - 1) * levelHeight(map, map.record.level_count - 1), 1u);
		EXPECT_EQ(map.texels.size(), (first + 3) / 4);
	}
}

TEST(heightMap, levelZeroIsTheRedChannelAsItIs)
{
	Image image = noiseImage(15, 4, TexelFormat::U16, 4);
	image.channels = 3;
	image.width = 5;
	const HeightMapData map = mapOf(image);
	for (uint32_t i = 0; i < 20; ++i)
	{
		uint16_t stored;
		std::memcpy(&stored, image.texels.data() + 6 * i, sizeof stored);
		EXPECT_FLOAT_EQ(texel(map, 0, i % 5, i / 5), float(stored) / 65535.0f);
	}
}

TEST(heightMap, floatTexelsThatAreNotFiniteBecomeZero)
{
	Image image = constantImage(4, 4, TexelFormat::F32, 2);
	const float bad[3] = { std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), 1e-30f };
	std::memcpy(image.texels.data(), bad, sizeof bad);
	const HeightMapData map = mapOf(image);
	EXPECT_EQ(texel(map, 0, 0, 0), 0.0f);
	EXPECT_EQ(texel(map, 0, 1, 0), 0.0f);
	EXPECT_EQ(texel(map, 0, 2, 0), 0.0f);
	EXPECT_FLOAT_EQ(texel(map, 2, 0, 0), 2.0f * 13 / 16);
}

TEST(heightRanges, containEveryHeightThatCanBeReadInTheFootprintOnAnyMip)
{
	std::mt19937 random(5);
	std::uniform_real_distribution<float> unit(0, 1);
	for (const uvec2 size : kSizes)
		for (const Wrap wrap : { Wrap::Repeat, Wrap::ClampToEdge, Wrap::MirroredRepeat })
		{
			const HeightMapData map = mapOf(noiseImage(size.x, size.y, TexelFormat::U8, size.x), wrap);
			const HeightMap record = hostRecord(map);
			const HeightRanges ranges(map);
			Surface surface = {};
			surface.height_maps = reinterpret_cast<uint64_t>(&record);
			for (int i = 0; i < 200; ++i)
			{
				const float scale = std::exp2(-8 * unit(random)) * 3;
				const vec2 low = vec2(unit(random), unit(random)) * 8.0f - 4.0f;
				const vec2 high = low + vec2(unit(random), unit(random)) * scale;
				const Interval range = ranges.over(low, high);
				for (int j = 0; j < 60; ++j)
				{
					const vec2 uv(j % 5 ? low.x + (high.x - low.x) * unit(random) : low.x, j % 7 ? low.y + (high.y - low.y) * unit(random) : high.y);
					const float level = std::min(12 * unit(random), float(record.level_count - 1));
					const float height = heightAt(surface, 0, glm::clamp(uv, low, high), j % 2 ? std::floor(level) : level);
					EXPECT_GE(height, range.low - 1e-6f);
					EXPECT_LE(height, range.high + 1e-6f);
				}
			}
		}
}

TEST(heightRanges, aFootprintInAFlatPartOfTheMapIsTight)
{
	// Only texels of the right half are 1; footprints well inside the left half cannot reach them on the fine mips.
	Image image = constantImage(256, 256, TexelFormat::U8, 0);
	for (uint32_t y = 0; y < 256; ++y)
		std::memset(image.texels.data() + 256 * y + 128, 255, 128);
	const HeightMapData map = mapOf(image, Wrap::ClampToEdge);
	const HeightRanges ranges(map);
	// At x = 1/4 the coarsest mip that has texels of one half alone is the one of 2 x 2, whose blend reads both.
	EXPECT_EQ(ranges.over(vec2(0.2f), vec2(0.21f)).low, 0.0f);
	EXPECT_EQ(ranges.over(vec2(0.6f, 0.2f), vec2(0.9f, 0.8f)).high, 1.0f);
}

TEST(heightRanges, hugeCoordinatesGiveTheWholeMap)
{
	for (const Wrap wrap : { Wrap::Repeat, Wrap::MirroredRepeat })
	{
		const HeightMapData map = mapOf(noiseImage(16, 16, TexelFormat::U8, 6), wrap);
		const HeightRanges ranges(map);
		const Interval whole = ranges.over(vec2(-2), vec2(2));
		const Interval far_away = ranges.over(vec2(3e38f), vec2(3e38f));
		EXPECT_EQ(far_away.low, whole.low);
		EXPECT_EQ(far_away.high, whole.high);
	}
}

}  // namespace tessera::test
