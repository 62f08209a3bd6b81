// Height maps with each texel's neighbours beside it hold what a reader of texels finds, and are kept while they are small.
#include "build_test_scenes.h"
#include "frame/height_footprints.h"
#include "plan/conditions.h"
#include "scene/build/height_map.h"
#include "shared/height.h"

#include <gtest/gtest.h>

namespace tessera::test
{

namespace
{

// By the definition: repeats go round, all others stay at the border for the two texels beyond it that are read.
uint32_t wrapped(int texel, int size, Wrap wrap)
{
	return uint32_t(wrap == Wrap::Repeat ? ((texel % size) + size) % size : std::clamp(texel, 0, size - 1));
}

void expectFootprints(const HeightMapData& map, Wrap wrap)
{
	const HeightFootprints kept = heightFootprints(map);
	EXPECT_EQ(kept.texels.size() * sizeof(uint32_t), footprintBytes(map));
	HeightMap record = kept.record;
	record.texels = reinterpret_cast<uint64_t>(kept.texels.data());
	uint32_t index = 0;
	for (uint32_t level = 0; level < map.record.level_count; ++level)
	{
		const int width = int(std::max(map.record.width >> level, 1u)), height = int(std::max(map.record.height >> level, 1u));
		EXPECT_EQ(record.level_first[level], index);
		const auto texel = [&](int x, int y) {
			return texelHeight(hostRecord(map), map.record.level_first[level] + wrapped(y, height, wrap) * uint32_t(width) + wrapped(x, width, wrap));
		};
		for (int y = -2; y <= height; ++y)
			for (int x = -2; x <= width; ++x)
			{
				const Footprint footprint = keptFootprint(record, index++);
				ASSERT_EQ(footprint.h00, texel(x, y)) << level << " " << x << " " << y;
				ASSERT_EQ(footprint.h10, texel(x + 1, y)) << level << " " << x << " " << y;
				ASSERT_EQ(footprint.h01, texel(x, y + 1)) << level << " " << x << " " << y;
				ASSERT_EQ(footprint.h11, texel(x + 1, y + 1)) << level << " " << x << " " << y;
			}
	}
}

}  // namespace

TEST(heightFootprints, holdEveryTexelWithItsNeighboursOnEveryMip)
{
	for (const TexelFormat format : { TexelFormat::U8, TexelFormat::U16, TexelFormat::F32 })
		for (const Wrap wrap : { Wrap::Repeat, Wrap::ClampToEdge, Wrap::MirroredRepeat })
			for (const auto& [width, height] : { std::pair(16u, 8u), std::pair(5u, 9u), std::pair(1u, 7u), std::pair(1u, 1u) })
			{
				Texture texture;
				texture.wrap_u = texture.wrap_v = wrap;
				expectFootprints(buildHeightMap(noiseImage(width, height, format, 7), texture, 1, 0), wrap);
			}
}

TEST(heightFootprints, areKeptUpToWhatTheDeviceAllows)
{
	PlanInput input;
	input.scene.has_displacement = true;
	input.sizes.height_footprint_bytes = 1000;
	input.device.most_footprint_bytes = 1000;
	EXPECT_TRUE(kHeightFootprints.holds(input));
	input.device.most_footprint_bytes = 999;
	EXPECT_FALSE(kHeightFootprints.holds(input));
	input.device.most_footprint_bytes = 1000;
	input.options.displacement_scale = 0;
	EXPECT_FALSE(kHeightFootprints.holds(input));
}

}  // namespace tessera::test
