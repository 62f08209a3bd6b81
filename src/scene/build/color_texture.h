// Colour textures as the GPU samples them.
#pragma once
#include "scene/scene.h"

namespace tessera
{

// 8-bit RGBA: missing channels are grey (one or two channels) and opaque; 16-bit and float values (clamped to 0..1) round to nearest.
ColorTexture buildColorTexture(const Image& image, const Texture& texture);

// A value clamped to 0..1 as 0..255, rounded to nearest.
uint8_t toByte(float value);

// RGBA, red in the lowest byte.
uint32_t packColor(vec4 color);

}  // namespace tessera
