#include "scene/image_decode.h"

#include "base/file.h"
#include "scene/image_exr.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_PSD
#define STBI_NO_PIC
#define STBI_NO_PNM
#define STBI_NO_GIF
#define STBI_NO_HDR     // stb's Radiance decoder never ends on some truncated files
#define STBI_NO_LINEAR  // belongs to it
#define STBI_MAX_DIMENSIONS 16384
#include <stb_image.h>

namespace tessera
{

static_assert(STBI_MAX_DIMENSIONS == kMaxImageSide);

struct Signature
{
	size_t offset;
	std::string_view bytes;
	const char* format;
};

// Formats that people put into glTF files and that we do not read, by their first bytes.
static constexpr Signature kUnsupported[] = {
	{ 0, { "\xabKTX 20\xbb\r\n\x1a\n", 12 }, "KTX2" },
	{ 0, { "\xabKTX 11\xbb\r\n\x1a\n", 12 }, "KTX" },
	{ 8, { "WEBP", 4 }, "WebP" },
	{ 0, { "sB", 2 }, "Basis Universal" },
	{ 0, { "DDS ", 4 }, "DDS" },
	{ 0, { "GIF8", 4 }, "GIF" },
	{ 0, { "8BPS", 4 }, "PSD" },
	{ 4, { "ftypavif", 8 }, "AVIF" },
	{ 0, { "#?", 2 }, "Radiance HDR" },
	{ 0, { "II*\0", 4 }, "TIFF" },
	{ 0, { "MM\0*", 4 }, "TIFF" },
};

static bool startsWith(std::span<const std::byte> bytes, size_t offset, std::string_view wanted)
{
	return bytes.size() >= offset + wanted.size() && std::memcmp(bytes.data() + offset, wanted.data(), wanted.size()) == 0;
}

static bool isReadable(std::span<const std::byte> bytes, const std::string& name)
{
	return startsWith(bytes, 0, "\x89PNG") || startsWith(bytes, 0, "\xff\xd8") || startsWith(bytes, 0, "BM") || startsWith(bytes, 0, "#?") ||
		   name.ends_with(".tga") || name.ends_with(".TGA");
}

struct StbFree
{
	void operator()(void* texels) const { stbi_image_free(texels); }
};

// stb_image decodes; it keeps 16-bit samples exactly and the channel count of the file.
static Result<Image> decodeStb(std::span<const std::byte> bytes, const std::string& name)
{
	if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
		return badInput("{}: has {} bytes, at most 2^31 - 1 can be read", name, bytes.size());
	const stbi_uc* data = reinterpret_cast<const stbi_uc*>(bytes.data());
	const int size = static_cast<int>(bytes.size());
	Image image;
	image.name = name;
	int width = 0;
	int height = 0;
	int channels = 0;
	if (stbi_info_from_memory(data, size, &width, &height, &channels) &&
		(width < 1 || height < 1 || width > STBI_MAX_DIMENSIONS || height > STBI_MAX_DIMENSIONS))
		return badInput("{}: is {} x {}, but sides from 1 to {} are right", name, width, height, kMaxImageSide);

	std::unique_ptr<void, StbFree> texels;
	size_t texel_size = 1;
	if (stbi_is_16_bit_from_memory(data, size))
	{
		image.format = TexelFormat::U16;
		texel_size = 2;
		texels.reset(stbi_load_16_from_memory(data, size, &width, &height, &channels, 0));
	}
	else
		texels.reset(stbi_load_from_memory(data, size, &width, &height, &channels, 0));
	if (!texels && std::string_view(stbi_failure_reason()) == "too large")
		return badInput("{}: is larger than {} x {}, the most that is read", name, kMaxImageSide, kMaxImageSide);
	if (!texels)
		return badInput("{}: cannot be decoded: {}", name, stbi_failure_reason());

	image.width = static_cast<uint32_t>(width);
	image.height = static_cast<uint32_t>(height);
	image.channels = static_cast<uint32_t>(channels);
	if (image.width < 1 || image.height < 1 || image.width > kMaxImageSide || image.height > kMaxImageSide || channels < 1 || channels > 4)
		return badInput("{}: is {} x {} with {} channels, which is not supported", name, width, height, channels);
	const std::byte* first = static_cast<const std::byte*>(texels.get());
	image.texels.assign(first, first + size_t(image.width) * image.height * image.channels * texel_size);
	return image;
}

static size_t zeroNonFinite(Image& image)
{
	float* values = reinterpret_cast<float*>(image.texels.data());
	const size_t count = image.texels.size() / sizeof(float);
	size_t replaced = 0;
	for (size_t i = 0; i < count; ++i)
		if (!std::isfinite(values[i]))
		{
			values[i] = 0;
			++replaced;
		}
	return replaced;
}

Result<Image> decodeImage(std::span<const std::byte> bytes, const std::string& name, std::vector<std::string>& warnings)
{
	for (const Signature& signature : kUnsupported)
		if (startsWith(bytes, signature.offset, signature.bytes))
			return badInput("{}: {} is not supported; PNG, JPEG or EXR is right", name, signature.format);
	if (!isExr(bytes) && !isReadable(bytes, name))
		return badInput("{}: is no image in a known format; PNG, JPEG or EXR is right", name);
	TRY_ASSIGN(Image image, isExr(bytes) ? decodeExr(bytes, name) : decodeStb(bytes, name));
	if (image.format == TexelFormat::F32)
		if (const size_t replaced = zeroNonFinite(image); replaced > 0)
			warnings.push_back(fmt::format("{} samples are NaN or infinite and replaced by 0", replaced));
	return image;
}

Result<Image> readImage(const std::filesystem::path& path, std::vector<std::string>& warnings)
{
	TRY_ASSIGN(const std::vector<std::byte> bytes, readFile(path));
	return decodeImage(bytes, path.string(), warnings);
}

}  // namespace tessera
