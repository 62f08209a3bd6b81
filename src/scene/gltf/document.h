// A glTF file as it lies on disk: its JSON (checked against the schema) and the bytes of its buffers.
#pragma once
#include "base/result.h"
#include "scene/gltf/warnings.h"

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessera
{

using Json = nlohmann::json;

// Bytes that a buffer of the file names: its own storage, or a part of the .glb file.
struct GltfBuffer
{
	std::vector<std::byte> owned;
	std::span<const std::byte> bytes;
};

// Moved only: its spans point into its own storage.
struct GltfDocument
{
	GltfDocument() = default;
	GltfDocument(GltfDocument&&) = default;
	GltfDocument& operator=(GltfDocument&&) = default;

	std::string file;              // path as the user gave it: the head of every message
	std::filesystem::path folder;  // where its relative URIs start
	std::vector<std::byte> file_bytes;
	std::span<const std::byte> binary_chunk;  // .glb only, a part of file_bytes
	bool has_binary_chunk = false;
	Json json;
	std::vector<GltfBuffer> buffers;  // one per entry of json["buffers"], at least byteLength long
	GltfWarnings warnings;

	// An Error of the form "file: place: what is wrong".
	template <typename... Args>
	[[nodiscard]] tl::unexpected<Error> bad(std::string_view place, fmt::format_string<Args...> format, Args&&... args) const
	{
		return badInput("{}", oneLine(fmt::format("{}: {}: {}", file, place, fmt::format(format, std::forward<Args>(args)...))));
	}
};

// Reads `bytes` as the .gltf or .glb file (told apart by its first bytes) at `path`, checks its JSON and loads its buffers. `path` names it in
// messages, and other files are read beside it.
// Errors: BadInput (broken container, JSON nested deeper than 128, schema, missing or short buffers, unsupported required extensions).
Result<GltfDocument> readGltfDocument(const std::filesystem::path& path, std::vector<std::byte> bytes);

// Bytes of bufferViews[index], which must be a valid index. Errors: BadInput when it reaches beyond its buffer.
Result<std::span<const std::byte>> bufferViewBytes(const GltfDocument& document, size_t index);

// The number of entries of the top-level array `name`; 0 when the file lacks it.
size_t entryCount(const Json& root, const char* name);

}  // namespace tessera
