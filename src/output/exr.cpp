#include "output/exr.h"

#include "base/check.h"

#include <cstring>
#include <string_view>

namespace tessera
{

namespace
{

class Bytes
{
public:
	template <typename T>
	void put(T value)
	{
		const auto* first = reinterpret_cast<const std::byte*>(&value);
		all.insert(all.end(), first, first + sizeof(T));
	}
	void text(std::string_view characters)
	{
		for (const char c : characters)
			put(c);
		put('\0');
	}
	void attribute(std::string_view name, std::string_view type, uint32_t bytes)
	{
		text(name);
		text(type);
		put(bytes);
	}

	std::vector<std::byte> all;
};

// Channels in the file's order, the alphabet's: their letters, and which of the texel's channels each is.
struct Channels
{
	std::string_view letters;
	uint32_t sources[4];
};
constexpr Channels kChannels[] = { { "Y", { 0 } }, { "AY", { 1, 0 } }, { "BGR", { 2, 1, 0 } }, { "ABGR", { 3, 2, 1, 0 } } };

void putHeader(Bytes& file, uint32_t width, uint32_t height, std::string_view letters)
{
	constexpr uint32_t kFloat = 2, kChannelBytes = 18;
	file.put(0x01312f76u);
	file.put(2u);
	file.attribute("channels", "chlist", uint32_t(letters.size()) * kChannelBytes + 1);
	for (const char letter : letters)
	{
		file.text({ &letter, 1 });
		for (const uint32_t word : { kFloat, 0u, 1u, 1u })
			file.put(word);
	}
	file.put('\0');
	file.attribute("compression", "compression", 1);
	file.put('\0');
	for (const char* window : { "dataWindow", "displayWindow" })
	{
		file.attribute(window, "box2i", 16);
		for (const uint32_t word : { 0u, 0u, width - 1, height - 1 })
			file.put(word);
	}
	file.attribute("lineOrder", "lineOrder", 1);
	file.put('\0');
	file.attribute("pixelAspectRatio", "float", 4);
	file.put(1.0f);
	file.attribute("screenWindowCenter", "v2f", 8);
	file.put(0.0f);
	file.put(0.0f);
	file.attribute("screenWindowWidth", "float", 4);
	file.put(1.0f);
	file.put('\0');
}

}  // namespace

std::vector<std::byte> encodeExr(uint32_t width, uint32_t height, uint32_t channels, std::span<const float> texels)
{
	CHECK(channels >= 1 && channels <= 4 && width > 0 && height > 0, "{} x {} x {}", width, height, channels);
	CHECK(texels.size() == size_t(width) * height * channels, "{} texels for {} x {} x {}", texels.size(), width, height, channels);
	const Channels& order = kChannels[channels - 1];
	Bytes file;
	putHeader(file, width, height, order.letters);
	const uint32_t line_bytes = width * channels * 4;
	const uint64_t first_line = file.all.size() + uint64_t(height) * 8;
	for (uint32_t y = 0; y < height; ++y)
		file.put(first_line + uint64_t(y) * (8 + line_bytes));
	for (uint32_t y = 0; y < height; ++y)
	{
		file.put(y);
		file.put(line_bytes);
		for (uint32_t c = 0; c < channels; ++c)
			for (uint32_t x = 0; x < width; ++x)
				file.put(texels[(size_t(y) * width + x) * channels + order.sources[c]]);
	}
	return std::move(file.all);
}

}  // namespace tessera
