// Image files into texels, exactly: nothing is scaled, premultiplied or widened.
#pragma once
#include "base/result.h"
#include "scene/imported_scene.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace tessera
{

inline constexpr uint32_t kMaxImageSide = 16384;

// Decodes PNG (8 and 16 bit), JPEG, BMP, TGA (only when `name` ends in .tga) and OpenEXR (see image_exr.h).
// The channel count is the file's: 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA.
// Texels of float images that are NaN or infinite become 0; a warning with their count is appended to `warnings`.
// Errors: BadInput "name: ..." (unknown or unsupported format by name, broken data, a side of 0 or above 16384).
Result<Image> decodeImage(std::span<const std::byte> bytes, const std::string& name, std::vector<std::string>& warnings);

// The same for a file.
Result<Image> readImage(const std::filesystem::path& path, std::vector<std::string>& warnings);

}  // namespace tessera
