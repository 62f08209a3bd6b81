// Whole files in and out. Output never leaves half a file: it is written without a name where the file system can (a killed program leaves
// nothing behind), else under a temporary one, and gets its name when it is whole.
#pragma once
#include "base/result.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace tessera
{

// Reads a whole file of at most `max_bytes`. Errors: BadInput (missing, a directory, too large, unreadable).
Result<std::vector<std::byte>> readFile(const std::filesystem::path& path, uint64_t max_bytes = uint64_t(1) << 34);

// Writes `bytes` to `path`, all or nothing; missing folders are made.
// Errors: BadInput with the path and the system's reason; nothing is left behind.
Status writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
Status writeFile(const std::filesystem::path& path, std::string_view text);

// The folder that holds the running program.
std::filesystem::path programFolder();

}  // namespace tessera
