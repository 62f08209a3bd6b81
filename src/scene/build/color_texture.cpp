#include "scene/build/color_texture.h"

#include "base/parallel.h"

#include <cstring>

namespace tessera
{

namespace
{

uint8_t byteAt(const Image& image, size_t value_index)
{
	if (image.format == TexelFormat::U8)
		return uint8_t(image.texels[value_index]);
	if (image.format == TexelFormat::U16)
	{
		uint16_t value;
		std::memcpy(&value, image.texels.data() + value_index * sizeof value, sizeof value);
		return uint8_t((uint32_t(value) * 255 + 32767) / 65535);
	}
	float value;
	std::memcpy(&value, image.texels.data() + value_index * sizeof value, sizeof value);
	return toByte(value);
}

}  // namespace

uint8_t toByte(float value)
{
	if (!(value > 0))
		return 0;
	return value >= 1 ? 255 : uint8_t(value * 255 + 0.5f);
}

uint32_t packColor(vec4 color)
{
	return toByte(color.x) | (uint32_t(toByte(color.y)) << 8) | (uint32_t(toByte(color.z)) << 16) | (uint32_t(toByte(color.w)) << 24);
}

ColorTexture buildColorTexture(const Image& image, const Texture& texture)
{
	ColorTexture result;
	result.name = image.name;
	result.width = image.width;
	result.height = image.height;
	result.wrap_u = texture.wrap_u;
	result.wrap_v = texture.wrap_v;
	result.nearest = texture.nearest;
	result.rgba.resize(size_t(4) * image.width * image.height);
	const bool grey = image.channels <= 2;
	const bool has_alpha = image.channels == 2 || image.channels == 4;
	parallelFor(image.height, [&](size_t row) {
		for (size_t texel = row * image.width; texel < (row + 1) * image.width; ++texel)
		{
			uint8_t* rgba = result.rgba.data() + 4 * texel;
			for (size_t channel = 0; channel < 3; ++channel)
				rgba[channel] = byteAt(image, texel * image.channels + (grey ? 0 : channel));
			rgba[3] = has_alpha ? byteAt(image, (texel + 1) * image.channels - 1) : 255;
		}
	});
	return result;
}

}  // namespace tessera
