#include "scene/images/image_stb.h"

#include "scene/images/jpeg_check.h"

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

struct StbFree
{
	void operator()(void* texels) const { stbi_image_free(texels); }
};

Result<Image> decodeStb(std::span<const std::byte> bytes, const std::string& name)
{
	if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
		return badInput("{}: has {} bytes, at most 2^31 - 1 can be read", name, bytes.size());
	TRY(checkJpeg(bytes, name));
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

bool inflateExactly(std::span<const std::byte> compressed, std::span<std::byte> out)
{
	constexpr size_t kMax = static_cast<size_t>(std::numeric_limits<int>::max());
	if (compressed.size() > kMax || out.size() > kMax)
		return false;
	const int length = stbi_zlib_decode_buffer(reinterpret_cast<char*>(out.data()), static_cast<int>(out.size()),
											   reinterpret_cast<const char*>(compressed.data()), static_cast<int>(compressed.size()));
	return length == static_cast<int>(out.size());
}

}  // namespace tessera
