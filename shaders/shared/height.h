// height.h: the height at a texture coordinate, texels fetched exactly and blended in float32 by us: hardware filters have
// 8-bit weights and differ between devices. Source: DESIGN.md, section 7.
#ifndef TESSERA_SHARED_HEIGHT_H
#define TESSERA_SHARED_HEIGHT_H
#include "shared/geometry.h"

SHARED_BEGIN

// Two neighbouring texels along one axis, and the weight of the second.
struct TexelPair
{
	uint first;
	uint second;
	float blend;
};

SHARED_FN bool repeats(uint wrap)
{
	return HAS_WRAP_REPEAT && (!(HAS_WRAP_CLAMP || HAS_WRAP_MIRROR) || wrap == WRAP_REPEAT);
}
SHARED_FN bool clamps(uint wrap)
{
	return HAS_WRAP_CLAMP && (!(HAS_WRAP_REPEAT || HAS_WRAP_MIRROR) || wrap == WRAP_CLAMP);
}

// Folds a texture coordinate into 0..1 by the wrap mode. Exact but for the last rounding.
SHARED_FN precise float foldCoordinate(float coordinate, uint wrap)
{
	if (clamps(wrap))
		return min(max(coordinate, 0.0f), 1.0f);
	if (repeats(wrap))
	{
		precise float folded = coordinate - floor(coordinate);
		return folded;
	}
	precise float half_coordinate = coordinate * 0.5f;
	precise float period = floor(half_coordinate) * 2.0f;
	precise float within = coordinate - period;
	precise float mirrored = 2.0f - within;
	return within > 1.0f ? mirrored : within;
}

SHARED_FN uint wrapTexel(int texel, uint size, uint wrap)
{
	bool repeating = repeats(wrap);
	if (texel < 0)
		return repeating ? size - 1u : 0u;
	if (uint(texel) >= size)
		return repeating ? 0u : size - 1u;
	return uint(texel);
}

SHARED_FN TexelPair texelPair(float folded, uint size, uint wrap)
{
	precise float scaled = folded * float(size);
	precise float texel = scaled - 0.5f;
	precise float base = floor(texel);
	precise float blend = texel - base;
	TexelPair pair;
	pair.first = wrapTexel(int(base), size, wrap);
	pair.second = wrapTexel(int(base) + 1, size, wrap);
	pair.blend = blend;
	return pair;
}

SHARED_FN precise float texelHeight(HeightMap map, uint texel)
{
	if (HAS_HEIGHT_U16 && (!(HAS_HEIGHT_U8 || HAS_HEIGHT_F32) || map.format == HEIGHT_U16))
	{
		uint word = AT(uint, map.texels, texel >> 1);
		precise float value16 = float((word >> ((texel & 1u) * 16u)) & 0xffffu) * 1.52590218966964e-05f;
		return value16;
	}
	if (HAS_HEIGHT_U8 && (!HAS_HEIGHT_F32 || map.format == HEIGHT_U8))
	{
		uint word = AT(uint, map.texels, texel >> 2);
		precise float value8 = float((word >> ((texel & 3u) * 8u)) & 0xffu) * 3.92156862745098e-03f;
		return value8;
	}
	return uintBitsToFloat(AT(uint, map.texels, texel));
}

SHARED_FN precise float blendHeights(float a, float b, float weight)
{
	precise float difference = b - a;
	precise float scaled = difference * weight;
	precise float sum = a + scaled;
	return sum;
}

// Height at folded coordinates on one mip level: bilinear.
SHARED_FN precise float levelHeight(HeightMap map, uint first, float u, float v, uint level)
{
	uint width = max(map.width >> level, 1u);
	uint height = max(map.height >> level, 1u);
	TexelPair column = texelPair(u, width, map.wrap_u);
	TexelPair row = texelPair(v, height, map.wrap_v);
	uint row_first = first + row.first * width;
	uint row_second = first + row.second * width;
	float h00 = texelHeight(map, row_first + column.first);
	float h10 = texelHeight(map, row_first + column.second);
	float h01 = texelHeight(map, row_second + column.first);
	float h11 = texelHeight(map, row_second + column.second);
	precise float top = blendHeights(h00, h10, column.blend);
	precise float bottom = blendHeights(h01, h11, column.blend);
	return blendHeights(top, bottom, row.blend);
}

// log2 from exponent and mantissa bits, linear between powers of two: error below 0.0861, equal on every device.
SHARED_FN precise float roughLog2(float value)
{
	int bits = int(floatBitsToUint(value) >> 8) - 0x3f8000;
	precise float result = float(bits) * 3.0517578125e-05f;
	return result;
}

// Mip level of a footprint: `footprint_squared` = (texels per segment)^2. Clamped to 0..level_count - 1.
SHARED_FN precise float heightLevel(float footprint_squared, uint level_count)
{
	if (!(footprint_squared > 1.0f))
		return 0.0f;
	precise float level = roughLog2(footprint_squared) * 0.5f;
	return min(level, float(level_count - 1u));
}

// What reading a level needs of a height map. Not its table of levels: an array copied whole to be indexed once costs registers.
SHARED_FN HeightMap heightMapHead(Surface surface, uint map_index)
{
	HeightMap map;
	map.texels = HEIGHT_MAP(surface, map_index, texels);
	map.width = HEIGHT_MAP(surface, map_index, width);
	map.height = HEIGHT_MAP(surface, map_index, height);
	map.format = HEIGHT_MAP(surface, map_index, format);
	map.wrap_u = HEIGHT_MAP(surface, map_index, wrap_u);
	map.wrap_v = HEIGHT_MAP(surface, map_index, wrap_v);
	return map;
}

// Height at a texture coordinate: two mips blended linearly. `map_index` into Surface.height_maps, `level` from heightLevel.
SHARED_FN precise float heightAt(Surface surface, uint map_index, vec2 uv, float level)
{
	HeightMap map = heightMapHead(surface, map_index);
	float u = foldCoordinate(uv.x, map.wrap_u);
	float v = foldCoordinate(uv.y, map.wrap_v);
	precise float base = floor(level);
	precise float blend = level - base;
	uint fine_level = uint(base);
	uint fine_first = HEIGHT_MAP(surface, map_index, level_first[fine_level]);
	precise float fine = levelHeight(map, fine_first, u, v, fine_level);
	if (blend == 0.0f)
		return fine;
	uint coarse_first = HEIGHT_MAP(surface, map_index, level_first[fine_level + 1u]);
	precise float coarse = levelHeight(map, coarse_first, u, v, fine_level + 1u);
	return blendHeights(fine, coarse, blend);
}

SHARED_END

#endif
