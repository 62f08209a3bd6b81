// Colour textures on the device: mips by repeated halving blits, samplers as the file asks.
#pragma once
#include "gpu/commands.h"
#include "scene/scene.h"

namespace tessera
{

Result<ImageResource> uploadColorTexture(Device& device, CommandRecorder& commands, const ColorTexture& texture);
Result<VkSampler> makeColorSampler(Device& device, const ColorTexture& texture);

}  // namespace tessera
