// PNG files, 8 and 16 bits per channel. Source of the format: W3C, Portable Network Graphics (Third Edition).
#pragma once
#include "base/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace tessera
{

// Texels to store: rows top to bottom, channels interleaved, no padding.
struct PngTexels
{
	uint32_t width = 0;                // 1..2^20
	uint32_t height = 0;               // 1..2^20
	uint32_t channels = 0;             // 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
	uint32_t bits = 8;                 // per channel: 8, or 16 in the host's byte order
	std::span<const std::byte> bytes;  // width * height * channels * bits / 8
};

// The bytes of a PNG file. A broken promise of PngTexels is our bug and fails a CHECK.
// Errors: BadInput when the compressor runs out of memory.
Result<std::vector<std::byte>> encodePng(const PngTexels& texels);

// Writes 8-bit texels of 1..4 channels. Errors: BadInput (path and reason); no partial file is left.
Status writePng(const std::filesystem::path& path, uint32_t width, uint32_t height, std::span<const uint8_t> texels, uint32_t channels);

// Writes 16-bit texels of 1..4 channels, such as heights.
Status writePng16(const std::filesystem::path& path, uint32_t width, uint32_t height, std::span<const uint16_t> texels, uint32_t channels = 1);

}  // namespace tessera
