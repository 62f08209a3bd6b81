#include "scene/image_exr.h"

#include <algorithm>
#include <cstring>
#include <fmt/ranges.h>
#include <tinyexr.h>

namespace tessera
{

namespace
{

// Owns what tinyexr allocates.
struct ExrFile
{
	EXRHeader header;
	EXRImage image;
	bool header_parsed = false;
	bool image_loaded = false;

	ExrFile()
	{
		InitEXRHeader(&header);
		InitEXRImage(&image);
	}
	ExrFile(const ExrFile&) = delete;
	ExrFile& operator=(const ExrFile&) = delete;
	~ExrFile()
	{
		if (image_loaded)
			FreeEXRImage(&image);
		if (header_parsed)
			FreeEXRHeader(&header);
	}
};

}  // namespace

static std::string takeMessage(const char* message)
{
	if (!message)
		return "is broken";
	std::string text = message;
	FreeEXRErrorMessage(message);
	std::replace(text.begin(), text.end(), '\n', ' ');
	return text;
}

bool isExr(std::span<const std::byte> bytes)
{
	constexpr unsigned char kMagic[4] = { 0x76, 0x2f, 0x31, 0x01 };
	return bytes.size() >= 4 && std::memcmp(bytes.data(), kMagic, 4) == 0;
}

static Status checkHeader(const EXRHeader& header, const std::string& name)
{
	const int64_t width = int64_t(header.data_window.max_x) - header.data_window.min_x + 1;
	const int64_t height = int64_t(header.data_window.max_y) - header.data_window.min_y + 1;
	if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
		return badInput("{}: is {} x {}, but sides from 1 to {} are right", name, width, height, kMaxImageSide);
	if (header.tiled && (header.tile_size_x < 1 || header.tile_size_y < 1 || header.tile_size_x > static_cast<int>(kMaxImageSide) ||
						 header.tile_size_y > static_cast<int>(kMaxImageSide)))
		return badInput("{}: tiles of {} x {} are not supported", name, header.tile_size_x, header.tile_size_y);
	for (int i = 0; i < header.num_channels; ++i)
	{
		const EXRChannelInfo& channel = header.channels[i];
		if (channel.pixel_type == TINYEXR_PIXELTYPE_UINT)
			return badInput("{}: channel {} holds integers, but half or float is right", name, channel.name);
		if (channel.x_sampling != 1 || channel.y_sampling != 1)
			return badInput("{}: channel {} is subsampled, which is not supported", name, channel.name);
	}
	return {};
}

// Which of the file's channels to keep, in our order.
static Result<std::vector<int>> chooseChannels(const EXRHeader& header, const std::string& name)
{
	const auto find = [&](const char* wanted) {
		for (int i = 0; i < header.num_channels; ++i)
			if (std::strcmp(header.channels[i].name, wanted) == 0)
				return i;
		return -1;
	};
	const int red = find("R");
	const int green = find("G");
	const int blue = find("B");
	const int alpha = find("A");
	const int grey = find("Y");
	std::vector<int> chosen;
	if (header.num_channels == 1)
		return std::vector<int>{ 0 };
	if (red >= 0 && green >= 0 && blue >= 0)
		chosen = { red, green, blue };
	else if (red >= 0)
		return std::vector<int>{ red };
	else if (grey >= 0)
		chosen = { grey };
	else
	{
		std::vector<std::string> names;
		for (int i = 0; i < header.num_channels; ++i)
			names.emplace_back(header.channels[i].name);
		return badInput("{}: has channels {}, but R, G, B or Y is right", name, fmt::join(names, ", "));
	}
	if (alpha >= 0)
		chosen.push_back(alpha);
	return chosen;
}

static Status copyTexels(const ExrFile& file, std::span<const int> channels, const std::string& name, Image& image)
{
	float* out = reinterpret_cast<float*>(image.texels.data());
	const size_t channel_count = channels.size();
	const auto copyBlock = [&](unsigned char** planes, size_t x0, size_t y0, size_t block_width, size_t block_height) {
		for (size_t y = 0; y < block_height && y0 + y < image.height; ++y)
			for (size_t x = 0; x < block_width && x0 + x < image.width; ++x)
				for (size_t c = 0; c < channel_count; ++c)
				{
					const float* plane = reinterpret_cast<const float*>(planes[channels[c]]);
					out[((y0 + y) * image.width + x0 + x) * channel_count + c] = plane[y * block_width + x];
				}
	};
	if (!file.header.tiled)
	{
		if (!file.image.images)
			return badInput("{}: has no texels", name);
		copyBlock(file.image.images, 0, 0, image.width, image.height);
		return {};
	}
	const size_t tile_width = static_cast<size_t>(file.header.tile_size_x);
	const size_t tile_height = static_cast<size_t>(file.header.tile_size_y);
	for (int i = 0; i < file.image.num_tiles; ++i)
	{
		const EXRTile& tile = file.image.tiles[i];
		if (!tile.images || tile.offset_x < 0 || tile.offset_y < 0)
			return badInput("{}: tile {} is missing", name, i);
		if (tile.level_x == 0 && tile.level_y == 0)
			copyBlock(tile.images, static_cast<size_t>(tile.offset_x) * tile_width, static_cast<size_t>(tile.offset_y) * tile_height, tile_width,
					  tile_height);
	}
	return {};
}

Result<Image> decodeExr(std::span<const std::byte> bytes, const std::string& name)
{
	const unsigned char* data = reinterpret_cast<const unsigned char*>(bytes.data());
	EXRVersion version = {};
	if (ParseEXRVersionFromMemory(&version, data, bytes.size()) != TINYEXR_SUCCESS)
		return badInput("{}: the OpenEXR header is broken", name);
	if (version.multipart || version.non_image)
		return badInput("{}: multi-part and deep OpenEXR files are not supported; one flat part is right", name);

	ExrFile file;
	const char* message = nullptr;
	if (ParseEXRHeaderFromMemory(&file.header, &version, data, bytes.size(), &message) != TINYEXR_SUCCESS)
		return badInput("{}: the OpenEXR header cannot be read: {}", name, takeMessage(message));
	file.header_parsed = true;
	TRY(checkHeader(file.header, name));
	TRY_ASSIGN(const std::vector<int> channels, chooseChannels(file.header, name));
	for (int i = 0; i < file.header.num_channels; ++i)
		file.header.requested_pixel_types[i] = TINYEXR_PIXELTYPE_FLOAT;
	if (LoadEXRImageFromMemory(&file.image, &file.header, data, bytes.size(), &message) != TINYEXR_SUCCESS)
		return badInput("{}: the OpenEXR texels cannot be read: {}", name, takeMessage(message));
	file.image_loaded = true;

	Image image;
	image.name = name;
	image.width = static_cast<uint32_t>(file.image.width);
	image.height = static_cast<uint32_t>(file.image.height);
	image.channels = static_cast<uint32_t>(channels.size());
	image.format = TexelFormat::F32;
	image.texels.resize(size_t(image.width) * image.height * image.channels * sizeof(float));
	TRY(copyTexels(file, channels, name, image));
	return image;
}

}  // namespace tessera
