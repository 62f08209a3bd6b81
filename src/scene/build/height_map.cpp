#include "scene/build/height_map.h"

#include "base/check.h"
#include "base/parallel.h"
#include "scene/build/directions.h"
#include "shared/height.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tessera
{

namespace
{

// A stored number of the image's red channel. T: uint8_t, uint16_t or float.
template <typename T>
double redTexel(const Image& image, size_t texel)
{
	T value;
	std::memcpy(&value, image.texels.data() + texel * image.channels * sizeof(T), sizeof value);
	if constexpr (std::is_same_v<T, float>)
		return cleanFloat(value);
	return value;
}

double redTexel(const Image& image, size_t texel)
{
	switch (image.format)
	{
	case TexelFormat::U8:
		return redTexel<uint8_t>(image, texel);
	case TexelFormat::U16:
		return redTexel<uint16_t>(image, texel);
	case TexelFormat::F32:
		break;
	}
	return redTexel<float>(image, texel);
}

// Source texels that one target texel covers along an axis; the weights sum to the axis's divisor.
struct Taps
{
	uint32_t first;
	uint32_t count;
	double weights[3];
};

Taps tapsOf(uint32_t target, uint32_t source_size)
{
	const uint32_t half = source_size / 2;
	if (source_size == 1)
		return { 0, 1, { 1, 0, 0 } };
	if (source_size % 2 == 0)
		return { 2 * target, 2, { 1, 1, 0 } };
	return { 2 * target, 3, { double(half - target), double(half), double(target + 1) } };
}

double divisorOf(uint32_t source_size)
{
	return source_size == 1 ? 1 : source_size % 2 == 0 ? 2 : source_size;
}

// One level and the next, unrounded. `read(texel)` gives the source's numbers.
template <typename Read>
std::vector<double> halve(uint32_t width, uint32_t height, const Read& read)
{
	const uint32_t half_width = std::max(width / 2, 1u);
	const uint32_t half_height = std::max(height / 2, 1u);
	std::vector<double> result(size_t(half_width) * half_height);
	const double divisor = divisorOf(width) * divisorOf(height);
	const uint32_t band = std::max(1u, 16384 / half_width);
	parallelFor((half_height + band - 1) / band, [&](size_t index) {
		std::vector<double> column_sums(width);
		for (uint32_t y = uint32_t(index) * band; y < std::min(half_height, uint32_t(index + 1) * band); ++y)
		{
			const Taps rows = tapsOf(y, height);
			std::fill(column_sums.begin(), column_sums.end(), 0.0);
			for (uint32_t tap = 0; tap < rows.count; ++tap)
				for (uint32_t x = 0; x < width; ++x)
					column_sums[x] += rows.weights[tap] * read(size_t(rows.first + tap) * width + x);
			for (uint32_t x = 0; x < half_width; ++x)
			{
				const Taps columns = tapsOf(x, width);
				double sum = 0;
				for (uint32_t tap = 0; tap < columns.count; ++tap)
					sum += columns.weights[tap] * column_sums[columns.first + tap];
				result[size_t(y) * half_width + x] = sum / divisor;
			}
		}
	});
	return result;
}

// Packs numbers into the stream of texels from `first` on.
template <typename T, typename Read>
void pack(std::vector<uint32_t>& words, size_t first, size_t count, const Read& read)
{
	auto* bytes = reinterpret_cast<std::byte*>(words.data());
	constexpr size_t kBand = 1 << 16;
	parallelFor((count + kBand - 1) / kBand, [&](size_t band) {
		for (size_t i = band * kBand; i < std::min(count, (band + 1) * kBand); ++i)
		{
			T value;
			if constexpr (std::is_same_v<T, float>)
				value = cleanFloat(read(i));
			else
				value = T(read(i) + 0.5);
			std::memcpy(bytes + (first + i) * sizeof(T), &value, sizeof value);
		}
	});
}

template <typename T>
void buildLevels(const Image& image, HeightMapData& map)
{
	size_t texel_count = 0;
	for (uint32_t level = 0; level < map.record.level_count; ++level)
	{
		map.record.level_first[level] = uint32_t(texel_count);
		texel_count += size_t(std::max(image.width >> level, 1u)) * std::max(image.height >> level, 1u);
	}
	map.texels.resize((texel_count * sizeof(T) + 3) / 4);
	const auto from_image = [&](size_t texel) {
		return redTexel<T>(image, texel);
	};
	pack<T>(map.texels, 0, size_t(image.width) * image.height, from_image);

	std::vector<double> finer;
	for (uint32_t level = 1; level < map.record.level_count; ++level)
	{
		const uint32_t width = std::max(image.width >> (level - 1), 1u);
		const uint32_t height = std::max(image.height >> (level - 1), 1u);
		const auto from_finer = [&](size_t texel) {
			return finer[texel];
		};
		finer = level == 1 ? halve(width, height, from_image) : halve(width, height, from_finer);
		pack<T>(map.texels, map.record.level_first[level], finer.size(), from_finer);
	}
}

}  // namespace

bool displacesByNothing(const Image& image, float factor, float offset)
{
	const double scale = image.format == TexelFormat::U8 ? 1 / 255.0 : image.format == TexelFormat::U16 ? 1 / 65535.0 : 1.0;
	const double first = redTexel(image, 0);
	if (float(first * scale) * factor + offset != 0)
		return false;
	const size_t count = size_t(image.width) * image.height;
	for (size_t i = 1; i < count && factor != 0; ++i)
		if (redTexel(image, i) != first)
			return false;
	return true;
}

HeightMapData buildHeightMap(const Image& image, const Texture& texture, float factor, float offset)
{
	HeightMapData map;
	map.name = image.name;
	map.record = {};
	map.record.width = image.width;
	map.record.height = image.height;
	map.record.level_count = uint32_t(std::bit_width(std::max(image.width, image.height)));
	map.record.format = uint32_t(image.format);
	map.record.wrap_u = uint32_t(texture.wrap_u);
	map.record.wrap_v = uint32_t(texture.wrap_v);
	map.record.factor = factor;
	map.record.offset = offset;
	CHECK(map.record.level_count >= 1 && map.record.level_count < MAX_HEIGHT_LEVELS, "{} is {} x {}", image.name, image.width, image.height);
	if (image.format == TexelFormat::U8)
		buildLevels<uint8_t>(image, map);
	else if (image.format == TexelFormat::U16)
		buildLevels<uint16_t>(image, map);
	else
		buildLevels<float>(image, map);
	return map;
}

HeightMap hostRecord(const HeightMapData& map)
{
	HeightMap record = map.record;
	record.texels = reinterpret_cast<uint64_t>(map.texels.data());
	return record;
}

}  // namespace tessera
