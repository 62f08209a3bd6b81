// stb_image, in one place.
#pragma once
#include "scene/image_decode.h"

namespace tessera
{

// PNG, JPEG, BMP or TGA. 16-bit samples stay exact, and the channel count is the file's.
// Errors: BadInput "name: ..." (broken data, a side above kMaxImageSide, 2 GiB or more).
Result<Image> decodeStb(std::span<const std::byte> bytes, const std::string& name);

// Inflates a zlib stream. False unless it is sound and fills `out` exactly.
bool inflateExactly(std::span<const std::byte> compressed, std::span<std::byte> out);

}  // namespace tessera
