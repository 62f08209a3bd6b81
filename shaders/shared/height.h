// height.h: the height at a texture coordinate, texels fetched exactly and blended in float32 by us: hardware filters have
// 8-bit weights and differ between devices. Source: DESIGN.md, section 7.
#ifndef TESSERA_SHARED_HEIGHT_H
#define TESSERA_SHARED_HEIGHT_H
#include "shared/geometry.h"

SHARED_BEGIN

// Where a coordinate falls between the centres of two neighbouring texels.
struct TexelPlace
{
	int first;    // -1 to size - 1
	float blend;  // weight of the second
};

// A texel, its right neighbour, and the two below, wrapped.
struct Footprint
{
	float h00;
	float h10;
	float h01;
	float h11;
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

// The texel at -2 to size + 1. Without the division that a remainder takes.
SHARED_FN uint wrapTexel(int texel, uint size, uint wrap)
{
	if (!repeats(wrap))
		return uint(min(max(texel, 0), int(size) - 1));
	int wrapped = texel < 0 ? texel + int(size) : texel;
	wrapped = wrapped < 0 ? wrapped + int(size) : wrapped;
	wrapped = wrapped >= int(size) ? wrapped - int(size) : wrapped;
	return uint(wrapped >= int(size) ? wrapped - int(size) : wrapped);
}

SHARED_FN TexelPlace texelPlace(float folded, uint size)
{
	precise float scaled = folded * float(size);
	precise float texel = scaled - 0.5f;
	precise float base = floor(texel);
	precise float blend = texel - base;
	TexelPlace place;
	place.first = int(base);
	place.blend = blend;
	return place;
}

SHARED_FN bool is16Bit(HeightMap map)
{
	return HAS_HEIGHT_U16 && (!(HAS_HEIGHT_U8 || HAS_HEIGHT_F32) || map.format == HEIGHT_U16);
}
SHARED_FN bool is8Bit(HeightMap map)
{
	return HAS_HEIGHT_U8 && (!HAS_HEIGHT_F32 || map.format == HEIGHT_U8);
}

// The lowest bits of a word.
SHARED_FN precise float height16(uint word)
{
	precise float value = float(word & 0xffffu) * 1.52590218966964e-05f;
	return value;
}
SHARED_FN precise float height8(uint word)
{
	precise float value = float(word & 0xffu) * 3.92156862745098e-03f;
	return value;
}

SHARED_FN precise float texelHeight(HeightMap map, uint texel)
{
	if (is16Bit(map))
		return height16(AT(uint, map.texels, texel >> 1) >> ((texel & 1u) * 16u));
	if (is8Bit(map))
		return height8(AT(uint, map.texels, texel >> 2) >> ((texel & 3u) * 8u));
	return uintBitsToFloat(AT(uint, map.texels, texel));
}

// Where footprints are kept, those of a level are rows of its width + FOOTPRINT_BORDER, the first one that of texel (-2, -2).
SHARED_FN Footprint keptFootprint(HeightMap map, uint index)
{
	Footprint result;
	if (is16Bit(map))
	{
		uint upper = AT(uint, map.texels, 2u * index);
		uint lower = AT(uint, map.texels, 2u * index + 1u);
		result.h00 = height16(upper);
		result.h10 = height16(upper >> 16);
		result.h01 = height16(lower);
		result.h11 = height16(lower >> 16);
	}
	else if (is8Bit(map))
	{
		uint word = AT(uint, map.texels, index);
		result.h00 = height8(word);
		result.h10 = height8(word >> 8);
		result.h01 = height8(word >> 16);
		result.h11 = height8(word >> 24);
	}
	else
	{
		result.h00 = uintBitsToFloat(AT(uint, map.texels, 4u * index));
		result.h10 = uintBitsToFloat(AT(uint, map.texels, 4u * index + 1u));
		result.h01 = uintBitsToFloat(AT(uint, map.texels, 4u * index + 2u));
		result.h11 = uintBitsToFloat(AT(uint, map.texels, 4u * index + 3u));
	}
	return result;
}

// The footprint whose first texel is (x, y), each -2 to the size of level `level`, which begins at `first`.
SHARED_FN Footprint footprintAt(HeightMap map, uint first, int x, int y, uint level)
{
	uint width = max(map.width >> level, 1u);
	uint height = max(map.height >> level, 1u);
	if (HAS_HEIGHT_FOOTPRINTS)
		return keptFootprint(map, first + min(uint(y + 2), height + 2u) * (width + FOOTPRINT_BORDER) + min(uint(x + 2), width + 2u));
	uint left = wrapTexel(x, width, map.wrap_u);
	uint right = wrapTexel(x + 1, width, map.wrap_u);
	uint upper = first + width * wrapTexel(y, height, map.wrap_v);
	uint lower = first + width * wrapTexel(y + 1, height, map.wrap_v);
	Footprint result;
	result.h00 = texelHeight(map, upper + left);
	result.h10 = texelHeight(map, upper + right);
	result.h01 = texelHeight(map, lower + left);
	result.h11 = texelHeight(map, lower + right);
	return result;
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
	TexelPlace column = texelPlace(u, max(map.width >> level, 1u));
	TexelPlace row = texelPlace(v, max(map.height >> level, 1u));
	Footprint texels = footprintAt(map, first, column.first, row.first, level);
	precise float top = blendHeights(texels.h00, texels.h10, column.blend);
	precise float bottom = blendHeights(texels.h01, texels.h11, column.blend);
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
