// What stb's JPEG decoder takes on trust.
#pragma once
#include "base/result.h"

#include <cstddef>
#include <span>
#include <string>

namespace tessera
{

// Walks the segments of a JPEG file as the decoder does, and refuses Huffman tables of more than 256 codes, which it would write past its
// own tables. Everything else is left to the decoder; bytes that are no JPEG file pass. Errors: BadInput "name: ...".
// Source of the format: ITU-T T.81, annex B.
Status checkJpeg(std::span<const std::byte> bytes, const std::string& name);

}  // namespace tessera
