// OpenEXR images, read by our own code: the packaged decoders abort or leak on broken files.
#pragma once
#include "scene/image_decode.h"

namespace tessera
{

bool isExr(std::span<const std::byte> bytes);

// Scanline files of one flat part, without compression or with RLE, ZIPS or ZIP; channels of half or float, not subsampled:
// the only one or Y, R alone, or R, G, B; Y and RGB with A when there is one. Half becomes float exactly.
// Errors: BadInput "name: ..." (any other kind of OpenEXR by name, broken data, sides above kMaxImageSide).
// Source of the format: "OpenEXR File Layout", openexr.com.
Result<Image> decodeExr(std::span<const std::byte> bytes, const std::string& name);

}  // namespace tessera
