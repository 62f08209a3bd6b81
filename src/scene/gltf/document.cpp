#include "scene/gltf/document.h"

#include "base/file.h"
#include "scene/gltf/schema.h"
#include "scene/gltf/uri.h"

#include <algorithm>
#include <cstring>

namespace tessera
{

namespace fs = std::filesystem;

static constexpr size_t kMaxNesting = 128;
static constexpr uint32_t kGlbMagic = 0x46546c67;
static constexpr uint32_t kJsonChunk = 0x4e4f534a;
static constexpr uint32_t kBinaryChunk = 0x004e4942;

size_t entryCount(const Json& root, const char* name)
{
	const auto found = root.find(name);
	return found != root.end() && found->is_array() ? found->size() : 0;
}

static uint32_t readU32(std::span<const std::byte> bytes, size_t offset)
{
	uint32_t value = 0;
	for (size_t i = 0; i < 4; ++i)
		value |= std::to_integer<uint32_t>(bytes[offset + i]) << (8 * i);
	return value;
}

static bool isGlb(std::span<const std::byte> bytes)
{
	return bytes.size() >= 4 && readU32(bytes, 0) == kGlbMagic;
}

// Finds the JSON chunk, and the binary chunk when there is one, of a .glb file.
static Result<std::span<const std::byte>> splitGlb(GltfDocument& document)
{
	const std::span<const std::byte> bytes = document.file_bytes;
	if (bytes.size() < 20)
		return document.bad("GLB header", "the file ends after {} bytes, but header and first chunk header need 20", bytes.size());
	const uint32_t version = readU32(bytes, 4);
	const uint32_t length = readU32(bytes, 8);
	if (version != 2)
		return document.bad("GLB header", "version is {}, but 2 is right", version);
	if (length > bytes.size() || length < 20)
		return document.bad("GLB header", "length is {}, but the file has {} bytes", length, bytes.size());

	std::span<const std::byte> json;
	size_t offset = 12;
	for (size_t chunk = 0; offset < length; ++chunk)
	{
		const std::string place = fmt::format("GLB chunk {}", chunk);
		if (length - offset < 8)
			return document.bad(place, "{} bytes are left for its header, but 8 are needed", length - offset);
		const uint32_t chunk_length = readU32(bytes, offset);
		const uint32_t type = readU32(bytes, offset + 4);
		offset += 8;
		if (chunk_length > length - offset)
			return document.bad(place, "length is {}, but only {} bytes are left in the file", chunk_length, length - offset);
		if (chunk == 0 && type != kJsonChunk)
			return document.bad(place, "type is {:#010x}, but the first chunk must be JSON ({:#010x})", type, kJsonChunk);
		if (chunk == 0)
			json = bytes.subspan(offset, chunk_length);
		if (chunk == 1 && type == kBinaryChunk)
		{
			document.binary_chunk = bytes.subspan(offset, chunk_length);
			document.has_binary_chunk = true;
		}
		offset += chunk_length;
	}
	return json;
}

// Nesting of the JSON text, counted before anything recursive sees it.
static size_t nestingDepth(std::string_view text)
{
	size_t depth = 0;
	size_t deepest = 0;
	bool in_string = false;
	for (size_t i = 0; i < text.size(); ++i)
	{
		const char c = text[i];
		if (in_string && c == '\\')
			++i;
		else if (c == '"')
			in_string = !in_string;
		else if (!in_string && (c == '{' || c == '['))
			deepest = std::max(deepest, ++depth);
		else if (!in_string && (c == '}' || c == ']') && depth > 0)
			--depth;
	}
	return deepest;
}

static Result<Json> parseJson(const GltfDocument& document, std::span<const std::byte> bytes)
{
	const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
	const size_t depth = nestingDepth(text);
	if (depth > kMaxNesting)
		return document.bad("JSON", "is nested {} levels deep, at most {} are read", depth, kMaxNesting);
	try
	{
		return Json::parse(text.begin(), text.end());
	}
	catch (const Json::exception& exception)
	{
		const std::string_view message = exception.what();
		const size_t head = message.find("] ");
		return document.bad("JSON", "{}", head == std::string_view::npos ? message : message.substr(head + 2));
	}
}

static Result<GltfBuffer> loadBuffer(const GltfDocument& document, size_t index)
{
	const Json& description = document.json["buffers"][index];
	const std::string place = fmt::format("buffers[{}]", index);
	const uint64_t wanted = description["byteLength"].get<uint64_t>();
	GltfBuffer buffer;
	if (const auto uri = description.find("uri"); uri != description.end())
	{
		Result<std::vector<std::byte>> content = readUri(document.folder, uri->get_ref<const std::string&>());
		if (!content)
			return document.bad(place + ".uri", "{}", content.error().message);
		buffer.owned = std::move(*content);
		buffer.bytes = buffer.owned;
	}
	else if (index == 0 && document.has_binary_chunk)
		buffer.bytes = document.binary_chunk;
	else if (description.contains("extensions") && description["extensions"].contains("EXT_meshopt_compression"))
		return document.bad(place, "EXT_meshopt_compression is not supported and the buffer has no uncompressed data; export without it");
	else
		return document.bad(place + ".uri", "is missing, and the file has no binary chunk for this buffer");

	if (buffer.bytes.size() < wanted)
		return document.bad(place + ".byteLength", "is {}, but its data has {} bytes", wanted, buffer.bytes.size());
	buffer.bytes = buffer.bytes.first(wanted);
	return buffer;
}

Result<std::span<const std::byte>> bufferViewBytes(const GltfDocument& document, size_t index)
{
	const Json& view = document.json["bufferViews"][index];
	const std::span<const std::byte> buffer = document.buffers[view["buffer"].get<size_t>()].bytes;
	const uint64_t offset = view.value("byteOffset", uint64_t(0));
	const uint64_t length = view["byteLength"].get<uint64_t>();
	if (offset > buffer.size() || length > buffer.size() - offset)
		return document.bad(fmt::format("bufferViews[{}]", index), "byteOffset {} and byteLength {} reach beyond buffers[{}], which has {} bytes",
							offset, length, view["buffer"].get<size_t>(), buffer.size());
	return buffer.subspan(offset, length);
}

Result<GltfDocument> readGltfDocument(const fs::path& path, std::vector<std::byte> bytes)
{
	GltfDocument document;
	document.file = path.string();
	document.folder = path.parent_path();
	document.file_bytes = std::move(bytes);
	std::span<const std::byte> json = document.file_bytes;
	if (isGlb(json))
	{
		TRY_ASSIGN(json, splitGlb(document));
	}
	TRY_ASSIGN(document.json, parseJson(document, json));
	TRY(checkGltfSchema(document));
	TRY(checkGltfExtensions(document));
	for (size_t i = 0; i < entryCount(document.json, "buffers"); ++i)
	{
		TRY_ASSIGN(GltfBuffer buffer, loadBuffer(document, i));
		document.buffers.push_back(std::move(buffer));
	}
	for (size_t i = 0; i < entryCount(document.json, "bufferViews"); ++i)
		TRY(bufferViewBytes(document, i));
	return document;
}

}  // namespace tessera
