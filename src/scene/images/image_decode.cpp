#include "scene/image_decode.h"

#include "base/file.h"
#include "scene/images/image_exr.h"
#include "scene/images/image_stb.h"

#include <cmath>
#include <cstring>

namespace tessera
{

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
