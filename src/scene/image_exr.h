// OpenEXR images, through tinyexr.
#pragma once
#include "scene/image_decode.h"

namespace tessera
{

bool isExr(std::span<const std::byte> bytes);

// Channels Y (or the only one), or R, G, B and A by name; scanline and tiled files of one part.
// Errors: BadInput "name: ..." (multi-part and deep files, integer or subsampled channels, sides above kMaxImageSide).
Result<Image> decodeExr(std::span<const std::byte> bytes, const std::string& name);

}  // namespace tessera
