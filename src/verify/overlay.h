// Violations as a picture.
#pragma once
#include "verify/picture.h"

namespace tessera::verify
{

// RGBA, rows top to bottom: `colors` in dim grey, base triangles with violations red, pixels that see the wrong thing magenta.
// `colors` and `picture` are of one frame.
std::vector<uint8_t> paintViolations(const VisiblePicture& picture, std::span<const uint8_t> colors, const CheckResult& marks);

}  // namespace tessera::verify
