#include "gltf_file.h"
#include "scene/image_decode.h"

#include <cmath>
#include <cstring>

namespace tessera
{

template <typename T>
static std::vector<T> texelsAs(const Image& image)
{
	std::vector<T> values(image.texels.size() / sizeof(T));
	std::memcpy(values.data(), image.texels.data(), image.texels.size());
	return values;
}

static Result<Image> decoded(const std::string& name, std::vector<std::string>* warnings = nullptr)
{
	std::vector<std::string> ignored;
	return readImage(dataFile(name), warnings ? *warnings : ignored);
}

static Result<Image> decodedText(std::string_view text, const std::string& name = "test")
{
	std::vector<std::string> ignored;
	return decodeImage(std::as_bytes(std::span(text.data(), text.size())), name, ignored);
}

TEST(imageDecode, sixteenBitPngKeepsEverySample)
{
	const Result<Image> image = decoded("height16.png");
	ASSERT_TRUE(image) << image.error().message;
	EXPECT_EQ(image->format, TexelFormat::U16);
	EXPECT_EQ(image->channels, 1u);
	EXPECT_EQ(texelsAs<uint16_t>(*image),
			  (std::vector<uint16_t>{ 0, 1, 257, 65535, 1000, 2000, 3000, 4000, 5, 6, 7, 8, 40000, 50000, 60000, 65000 }));
}

TEST(imageDecode, eightBitPngKeepsItsChannelsAndSamples)
{
	EXPECT_EQ(texelsAs<uint8_t>(*decoded("height8.png")), (std::vector<uint8_t>{ 0, 64, 128, 255 }));
	EXPECT_EQ(texelsAs<uint8_t>(*decoded("color.png")), (std::vector<uint8_t>{ 255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 0 }));
	const Result<Image> image = decoded("color_alpha.png");
	ASSERT_TRUE(image);
	EXPECT_EQ(image->width, 2u);
	EXPECT_EQ(image->height, 1u);
	EXPECT_EQ(texelsAs<uint8_t>(*image), (std::vector<uint8_t>{ 10, 20, 30, 40, 50, 60, 70, 80 }));
}

TEST(imageDecode, jpegIsCloseToItsColour)
{
	const Result<Image> image = decoded("color.jpg");
	ASSERT_TRUE(image) << image.error().message;
	EXPECT_EQ(image->channels, 3u);
	EXPECT_NEAR(std::to_integer<int>(image->texels[0]), 200, 4);
	EXPECT_NEAR(std::to_integer<int>(image->texels[1]), 100, 4);
	EXPECT_NEAR(std::to_integer<int>(image->texels[2]), 50, 4);
}

TEST(imageDecode, floatImagesKeepTheirValues)
{
	for (const char* name : { "height_float.exr", "height_half.exr" })
	{
		const Result<Image> image = decoded(name);
		ASSERT_TRUE(image) << image.error().message;
		EXPECT_EQ(image->format, TexelFormat::F32);
		EXPECT_EQ(image->channels, 1u);
		const std::vector<float> values = texelsAs<float>(*image);
		for (size_t y = 0; y < 4; ++y)
			for (size_t x = 0; x < 4; ++x)
				EXPECT_EQ(values[4 * y + x], static_cast<float>(x) * 0.25f - static_cast<float>(y)) << name;
	}
	const Result<Image> color = decoded("color_float.exr");
	ASSERT_TRUE(color) << color.error().message;
	EXPECT_EQ(color->channels, 4u);
	EXPECT_EQ(texelsAs<float>(*color)[4 * 1000], 1000.0f);
	EXPECT_EQ(texelsAs<float>(*color)[4 * 1000 + 2], 0.25f);
}

TEST(imageDecode, compressedExrGivesItsValuesAndOtherCompressionsAreRefusedByName)
{
	for (const char* name : { "height_rle.exr", "height_zips.exr" })
	{
		const Result<Image> image = decoded(name);
		ASSERT_TRUE(image) << image.error().message;
		ASSERT_EQ(image->width, 20u);
		ASSERT_EQ(image->height, 18u);
		const std::vector<float> values = texelsAs<float>(*image);
		for (size_t y = 0; y < 18; ++y)
			for (size_t x = 0; x < 20; ++x)
				EXPECT_EQ(values[20 * y + x], static_cast<float>(y) * 0.5f + (x == 7 ? 1.25f : 0.0f)) << name << " " << x << " " << y;
	}
	const Result<Image> image = decoded("height_piz.exr");
	ASSERT_FALSE(image);
	EXPECT_NE(image.error().message.find("PIZ compression is not supported; none, RLE, ZIPS or ZIP is right"), std::string::npos);
}

TEST(imageDecode, samplesThatAreNotFiniteBecomeZeroAndAreCounted)
{
	std::vector<std::string> warnings;
	const Result<Image> image = decoded("height_not_finite.exr", &warnings);
	ASSERT_TRUE(image) << image.error().message;
	EXPECT_EQ(warnings, (std::vector<std::string>{ "3 samples are NaN or infinite and replaced by 0" }));
	const std::vector<float> values = texelsAs<float>(*image);
	for (size_t i = 0; i < 16; ++i)
		EXPECT_TRUE(i >= 1 && i <= 3 ? values[i] == 0 : std::isfinite(values[i]));
}

TEST(imageDecode, unsupportedFormatsAreRefusedByName)
{
	using namespace std::string_view_literals;
	const std::pair<std::string_view, const char*> formats[] = {
		{ "\xabKTX 20\xbb\r\n\x1a\n and more"sv, "KTX2 is not supported" },
		{ "RIFF\x10\0\0\0WEBPVP8 "sv, "WebP is not supported" },
		{ "sB\x13\0rest"sv, "Basis Universal is not supported" },
		{ "DDS |"sv, "DDS is not supported" },
		{ "#?RADIANCE\n"sv, "Radiance HDR is not supported" },
		{ "GIF89a"sv, "GIF is not supported" },
		{ "II*\0rest"sv, "TIFF is not supported" },
		{ "hello"sv, "is no image in a known format" },
		{ ""sv, "is no image in a known format" },
	};
	for (const auto& [bytes, message] : formats)
	{
		const Result<Image> image = decodedText(bytes, "place");
		ASSERT_FALSE(image);
		EXPECT_EQ(image.error().code, ExitCode::BadInput);
		EXPECT_TRUE(image.error().message.starts_with("place: ")) << image.error().message;
		EXPECT_NE(image.error().message.find(message), std::string::npos) << image.error().message;
	}
}

TEST(imageDecode, imagesAbove16384AreRefused)
{
	// Only the header matters: 16385 x 1, 8-bit grey.
	std::vector<std::byte> bytes = readBytes(dataFile("height8.png"));
	bytes[18] = std::byte(0x40);
	bytes[19] = std::byte(0x01);
	std::vector<std::string> warnings;
	const Result<Image> image = decodeImage(bytes, "large", warnings);
	ASSERT_FALSE(image);
	EXPECT_EQ(image.error().message, "large: is larger than 16384 x 16384, the most that is read");
}

// Broken images must never crash; a prefix may still decode where the format allows it (JPEG).
TEST(imageDecode, everyTruncatedPrefixAndEveryFlippedByteIsDecodedOrRefused)
{
	for (const char* name :
		 { "color.png", "color_alpha.png", "height16.png", "color.jpg", "height_float.exr", "height_half.exr", "height_rle.exr", "height_zips.exr" })
	{
		const std::vector<std::byte> bytes = readBytes(dataFile(name));
		std::vector<std::string> warnings;
		for (size_t length = 0; length < bytes.size(); ++length)
		{
			const std::vector<std::byte> prefix(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
			const Result<Image> image = decodeImage(prefix, name, warnings);
			EXPECT_TRUE(image || !image.error().message.empty());
		}
		for (size_t at = 0; at < bytes.size(); ++at)
		{
			std::vector<std::byte> flipped = bytes;
			flipped[at] ^= std::byte(0x55);
			const Result<Image> image = decodeImage(flipped, name, warnings);
			EXPECT_TRUE(image || !image.error().message.empty());
		}
	}
}

}  // namespace tessera
