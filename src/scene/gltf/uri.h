// URIs of a glTF file: embedded data, or files that must lie in the glTF file's own folder or below it.
#pragma once
#include "base/result.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tessera
{

// Undoes %XX. Errors: a % that two hexadecimal digits do not follow, or a NUL byte.
Result<std::string> percentDecoded(std::string_view text);

// The file that a relative URI names. Absolute paths, other schemes, backslashes and paths that leave `folder`
// (by .. or through links) are errors; the message lacks file and place. The file need not exist.
Result<std::filesystem::path> confinedPath(const std::filesystem::path& folder, std::string_view uri);

// Content of a data URI (base64 or percent-encoded) or of a confined file.
// Errors: as confinedPath and readFile, broken base64; the message lacks file and place.
Result<std::vector<std::byte>> readUri(const std::filesystem::path& folder, std::string_view uri);

// For messages: `uri`, at most 80 characters of it, control characters replaced.
std::string shownUri(std::string_view uri);

}  // namespace tessera
