// OpenEXR files of float texels, uncompressed. Source of the format: "OpenEXR File Layout", openexr.com.
#pragma once
#include "base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tessera
{

// The bytes of a file of width x height texels, rows top to bottom, 1..4 channels interleaved: Y, Y and A, R G B, R G B A. All floats are
// stored as they are, NaN and infinity too. A number of texels that does not fit the sides is our bug and fails a CHECK.
std::vector<std::byte> encodeExr(uint32_t width, uint32_t height, uint32_t channels, std::span<const float> texels);

}  // namespace tessera
