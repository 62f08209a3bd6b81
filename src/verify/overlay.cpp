#include "verify/overlay.h"

namespace tessera::verify
{

namespace
{

struct Color
{
	uint8_t r, g, b;
};
constexpr Color kTriangle = { 255, 40, 30 }, kPixel = { 255, 0, 255 };

uint8_t dimGrey(std::span<const uint8_t> rgba)
{
	return uint8_t((54 * rgba[0] + 183 * rgba[1] + 19 * rgba[2]) / 256 / 2 + 30);
}

bool isMarked(const VisiblePixel& pixel, const CheckResult& marks)
{
	const auto& words = pixel.identity.words;
	return pixel.covered() && marks.marked_triangles.count({ words[0], words[1], words[2] }) > 0;
}

}  // namespace

std::vector<uint8_t> paintViolations(const VisiblePicture& picture, std::span<const uint8_t> colors, const CheckResult& marks)
{
	std::vector<uint8_t> painted(colors.size());
	for (size_t i = 0; i < colors.size() / 4; ++i)
	{
		const uint8_t grey = dimGrey(colors.subspan(4 * i, 4));
		Color color = { grey, grey, grey };
		if (i < picture.pixels.size() && isMarked(picture.pixels[i], marks))
			color = kTriangle;
		if (marks.marked_pixels.count(static_cast<uint32_t>(i)) > 0)
			color = kPixel;
		painted[4 * i] = color.r;
		painted[4 * i + 1] = color.g;
		painted[4 * i + 2] = color.b;
		painted[4 * i + 3] = 255;
	}
	return painted;
}

}  // namespace tessera::verify
