#include "output/png.h"

#include "base/check.h"
#include "base/file.h"
#include "base/parallel.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace tessera
{

using Bytes = std::vector<std::byte>;

static void appendBigEndian(Bytes& bytes, uint32_t value)
{
	for (int shift = 24; shift >= 0; shift -= 8)
		bytes.push_back(std::byte(value >> shift));
}

static void appendText(Bytes& bytes, std::string_view text)
{
	for (const char c : text)
		bytes.push_back(std::byte(c));
}

static void appendChunk(Bytes& file, std::string_view type, std::span<const std::byte> data)
{
	appendBigEndian(file, uint32_t(data.size()));
	const size_t start = file.size();
	appendText(file, type);
	file.insert(file.end(), data.begin(), data.end());
	const auto* covered = reinterpret_cast<const Bytef*>(file.data() + start);
	appendBigEndian(file, uint32_t(crc32_z(0, covered, file.size() - start)));
}

// --- filters: each row is stored as differences to its neighbours --------------------------------------------------------------------

static int paeth(int left, int up, int corner)
{
	const int guess = left + up - corner;
	const int to_left = std::abs(guess - left), to_up = std::abs(guess - up), to_corner = std::abs(guess - corner);
	if (to_left <= to_up && to_left <= to_corner)
		return left;
	return to_up <= to_corner ? up : corner;
}

// Filters one row; `above` is the row before (zeros for the first), `step` the bytes of a pixel. Returns the sum of the magnitudes.
template <typename Predict>
static uint64_t filterRow(std::span<const uint8_t> row, std::span<const uint8_t> above, size_t step, std::span<uint8_t> out, Predict predict)
{
	uint64_t sum = 0;
	for (size_t i = 0; i < row.size(); ++i)
	{
		const int left = i < step ? 0 : row[i - step], corner = i < step ? 0 : above[i - step];
		out[i] = uint8_t(row[i] - predict(left, int(above[i]), corner));
		sum += uint64_t(std::abs(int(int8_t(out[i]))));
	}
	return sum;
}

// Writes the filter's number and the row filtered by the one whose output is smallest (the specification's heuristic, section 12.7).
static void filterBest(std::span<const uint8_t> row, std::span<const uint8_t> above, size_t step, std::span<uint8_t> out)
{
	std::vector<uint8_t> attempt(row.size());
	uint64_t best = ~uint64_t(0);
	const auto consider = [&](uint8_t number, auto predict) {
		const uint64_t sum = filterRow(row, above, step, attempt, predict);
		if (sum >= best)
			return;
		best = sum;
		out[0] = number;
		std::copy(attempt.begin(), attempt.end(), out.begin() + 1);
	};
	consider(2, [](int, int up, int) { return up; });
	consider(1, [](int left, int, int) { return left; });
	consider(3, [](int left, int up, int) { return (left + up) / 2; });
	consider(4, paeth);
}

// The texels as the file's byte stream: big-endian.
static std::vector<uint8_t> bigEndianBytes(const PngTexels& texels)
{
	std::vector<uint8_t> bytes(texels.bytes.size());
	std::memcpy(bytes.data(), texels.bytes.data(), bytes.size());
	if (texels.bits == 16 && std::endian::native == std::endian::little)
		for (size_t i = 0; i < bytes.size(); i += 2)
			std::swap(bytes[i], bytes[i + 1]);
	return bytes;
}

static std::vector<uint8_t> filterRows(const PngTexels& texels)
{
	const size_t step = size_t(texels.channels) * texels.bits / 8, row_bytes = step * texels.width;
	const std::vector<uint8_t> raw = bigEndianBytes(texels);
	const std::vector<uint8_t> zeros(row_bytes);
	std::vector<uint8_t> filtered((row_bytes + 1) * texels.height);
	parallelFor(texels.height, [&](size_t y) {
		const std::span<const uint8_t> row = std::span(raw).subspan(y * row_bytes, row_bytes);
		const std::span<const uint8_t> above = y == 0 ? std::span(zeros) : std::span(raw).subspan((y - 1) * row_bytes, row_bytes);
		filterBest(row, above, step, std::span(filtered).subspan(y * (row_bytes + 1), row_bytes + 1));
	});
	return filtered;
}

// --- file ----------------------------------------------------------------------------------------------------------------------------

static Result<Bytes> deflated(std::span<const uint8_t> data)
{
	// Level 4 is within a few per cent of the best on filtered pictures, at a third of the time.
	constexpr int kLevel = 4;
	uLongf size = compressBound(uLong(data.size()));
	Bytes bytes(size);
	if (compress2(reinterpret_cast<Bytef*>(bytes.data()), &size, data.data(), uLong(data.size()), kLevel) != Z_OK)
		return badInput("a PNG of {} bytes cannot be compressed: out of memory", data.size());
	bytes.resize(size);
	return bytes;
}

static void checkTexels(const PngTexels& texels)
{
	CHECK(texels.width >= 1 && texels.width <= 1u << 20, "width {}", texels.width);
	CHECK(texels.height >= 1 && texels.height <= 1u << 20, "height {}", texels.height);
	CHECK(texels.channels >= 1 && texels.channels <= 4, "channels {}", texels.channels);
	CHECK(texels.bits == 8 || texels.bits == 16, "bits {}", texels.bits);
	const size_t wanted = size_t(texels.width) * texels.height * texels.channels * texels.bits / 8;
	CHECK(texels.bytes.size() == wanted, "{} bytes given, {} wanted", texels.bytes.size(), wanted);
}

Result<Bytes> encodePng(const PngTexels& texels)
{
	checkTexels(texels);
	constexpr std::array<uint8_t, 5> kColorTypes = { 0, 0, 4, 2, 6 };
	Bytes header;
	appendBigEndian(header, texels.width);
	appendBigEndian(header, texels.height);
	for (const uint32_t value : { texels.bits, uint32_t(kColorTypes[texels.channels]), 0u, 0u, 0u })
		header.push_back(std::byte(value));
	TRY_ASSIGN(const Bytes data, deflated(filterRows(texels)));

	Bytes file;
	file.reserve(data.size() + 4096);
	appendText(file, "\x89PNG\r\n\x1a\n");
	appendChunk(file, "IHDR", header);
	// A chunk holds less than 2^31 bytes; large pictures take several.
	constexpr size_t kMost = size_t(1) << 30;
	for (size_t first = 0; first < data.size(); first += kMost)
		appendChunk(file, "IDAT", std::span(data).subspan(first, std::min(kMost, data.size() - first)));
	appendChunk(file, "IEND", {});
	return file;
}

static Status writeTexels(const std::filesystem::path& path, const PngTexels& texels)
{
	TRY_ASSIGN(const Bytes file, encodePng(texels));
	return writeFile(path, file);
}

Status writePng(const std::filesystem::path& path, uint32_t width, uint32_t height, std::span<const uint8_t> texels, uint32_t channels)
{
	return writeTexels(path, { width, height, channels, 8, std::as_bytes(texels) });
}

Status writePng16(const std::filesystem::path& path, uint32_t width, uint32_t height, std::span<const uint16_t> texels, uint32_t channels)
{
	return writeTexels(path, { width, height, channels, 16, std::as_bytes(texels) });
}

}  // namespace tessera
