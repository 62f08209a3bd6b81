#include "scene/images/image_exr.h"

#include "scene/images/image_stb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

namespace tessera
{

enum ExrCompression : uint8_t
{
	kNone = 0,
	kRle = 1,
	kZips = 2,  // zlib, one scanline per block
	kZip = 3,   // zlib, 16 scanlines per block
};

static constexpr std::array kCompressionNames = { "none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB" };
static constexpr uint32_t kHalf = 1;
static constexpr uint32_t kFloat = 2;
static constexpr size_t kMaxChannels = 64;

struct ExrChannel
{
	std::string name;
	uint32_t type = 0;        // kHalf or kFloat
	size_t bytes_before = 0;  // per pixel, of the channels stored before this one

	size_t size() const { return type == kHalf ? 2 : 4; }
};

struct ExrHeader
{
	std::vector<ExrChannel> channels;  // in the file's order
	size_t pixel_bytes = 0;
	int32_t first_y = 0;
	size_t width = 0;
	size_t height = 0;
	uint8_t compression = kNone;

	size_t linesPerBlock() const { return compression == kZip ? 16 : 1; }
};

namespace
{

// Reads little-endian values; past the end everything is zero and `failed` is set.
class ByteReader
{
public:
	explicit ByteReader(std::span<const std::byte> bytes, size_t offset = 0) : m_rest(bytes.subspan(std::min(offset, bytes.size()))) {}

	uint64_t number(size_t size)
	{
		uint64_t value = 0;
		const std::span<const std::byte> read = take(size);
		for (size_t i = 0; i < read.size(); ++i)
			value |= std::to_integer<uint64_t>(read[i]) << (8 * i);
		return value;
	}
	uint32_t u32() { return static_cast<uint32_t>(number(4)); }
	int32_t i32() { return std::bit_cast<int32_t>(u32()); }

	// Up to the next zero byte, which is skipped.
	std::string text()
	{
		const auto end = std::find(m_rest.begin(), m_rest.end(), std::byte(0));
		const size_t length = static_cast<size_t>(end - m_rest.begin());
		const std::span<const std::byte> read = take(length);
		take(1);
		return { reinterpret_cast<const char*>(read.data()), read.size() };
	}

	std::span<const std::byte> take(size_t size)
	{
		if (size > m_rest.size())
		{
			m_failed = true;
			m_rest = {};
			return {};
		}
		const std::span<const std::byte> taken = m_rest.first(size);
		m_rest = m_rest.subspan(size);
		return taken;
	}

	bool failed() const { return m_failed; }
	size_t left() const { return m_rest.size(); }

private:
	std::span<const std::byte> m_rest;
	bool m_failed = false;
};

}  // namespace

bool isExr(std::span<const std::byte> bytes)
{
	return bytes.size() >= 4 && ByteReader(bytes).u32() == 0x01312f76;
}

static Status readChannels(std::span<const std::byte> value, const std::string& name, ExrHeader& header)
{
	ByteReader reader(value);
	while (reader.left() > 1)
	{
		ExrChannel channel;
		channel.name = reader.text();
		channel.type = reader.u32();
		reader.take(4);
		const uint32_t x_sampling = reader.u32();
		const uint32_t y_sampling = reader.u32();
		if (reader.failed() || header.channels.size() == kMaxChannels)
			return badInput("{}: the channel list is broken", name);
		if (channel.type != kHalf && channel.type != kFloat)
			return badInput("{}: channel {} holds integers, but half or float is right", name, header.channels.size());
		if (x_sampling != 1 || y_sampling != 1)
			return badInput("{}: channel {} is subsampled, which is not supported", name, header.channels.size());
		channel.bytes_before = header.pixel_bytes;
		header.pixel_bytes += channel.size();
		header.channels.push_back(std::move(channel));
	}
	return {};
}

static Status readWindow(std::span<const std::byte> value, const std::string& name, ExrHeader& header)
{
	ByteReader reader(value);
	const int32_t first_x = reader.i32();
	header.first_y = reader.i32();
	const int64_t width = int64_t(reader.i32()) - first_x + 1;
	const int64_t height = int64_t(reader.i32()) - header.first_y + 1;
	if (reader.failed() || width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
		return badInput("{}: is {} x {}, but sides from 1 to {} are right", name, width, height, kMaxImageSide);
	header.width = static_cast<size_t>(width);
	header.height = static_cast<size_t>(height);
	return {};
}

// Reads all attributes and leaves `reader` at the block table.
static Result<ExrHeader> readHeader(ByteReader& reader, const std::string& name)
{
	constexpr uint32_t kTiled = 0x200;
	constexpr uint32_t kDeep = 0x800;
	constexpr uint32_t kMultiPart = 0x1000;
	reader.u32();
	const uint32_t version = reader.u32();
	if ((version & 0xff) != 2 || reader.failed())
		return badInput("{}: the OpenEXR version is not 2", name);
	if (version & (kTiled | kDeep | kMultiPart))
		return badInput("{}: tiled, deep and multi-part OpenEXR files are not supported; one flat part of scanlines is right", name);

	ExrHeader header;
	bool has_compression = false;
	for (;;)
	{
		const std::string attribute = reader.text();
		if (attribute.empty() && !reader.failed())
			break;
		reader.text();
		const std::span<const std::byte> value = reader.take(reader.u32());
		if (reader.failed())
			return badInput("{}: the OpenEXR header is cut short", name);
		if (attribute == "channels")
			TRY(readChannels(value, name, header));
		else if (attribute == "dataWindow")
			TRY(readWindow(value, name, header));
		else if (attribute == "compression" && value.size() == 1)
		{
			header.compression = std::to_integer<uint8_t>(value[0]);
			has_compression = true;
		}
	}
	if (header.channels.empty() || header.width == 0 || !has_compression)
		return badInput("{}: the OpenEXR header lacks channels, dataWindow or compression", name);
	if (header.compression > kZip)
		return badInput("{}: {} compression is not supported; none, RLE, ZIPS or ZIP is right", name,
						header.compression < kCompressionNames.size() ? kCompressionNames[header.compression] : "unknown");
	return header;
}

// Which of the file's channels to keep, in our order.
static Result<std::vector<const ExrChannel*>> chooseChannels(const ExrHeader& header, const std::string& name)
{
	const auto find = [&](std::string_view wanted) -> const ExrChannel* {
		for (const ExrChannel& channel : header.channels)
			if (channel.name == wanted)
				return &channel;
		return nullptr;
	};
	const ExrChannel* const red = find("R");
	std::vector<const ExrChannel*> chosen;
	if (header.channels.size() == 1)
		return std::vector{ &header.channels.front() };
	if (red && find("G") && find("B"))
		chosen = { red, find("G"), find("B") };
	else if (red)
		return std::vector{ red };
	else if (find("Y"))
		chosen = { find("Y") };
	else
		return badInput("{}: none of its {} channels is R or Y, which are the ones that are read", name, header.channels.size());
	if (find("A"))
		chosen.push_back(find("A"));
	return chosen;
}

// Runs: a count c >= 0 repeats the next byte c + 1 times, c < 0 copies the next -c bytes.
static bool expandRuns(std::span<const std::byte> packed, std::span<std::byte> out)
{
	size_t in = 0;
	size_t filled = 0;
	while (in < packed.size())
	{
		const int count = std::to_integer<int8_t>(packed[in++]);
		const size_t length = static_cast<size_t>(count < 0 ? -count : count + 1);
		const size_t stored = count < 0 ? length : 1;
		if (length > out.size() - filled || stored > packed.size() - in)
			return false;
		if (count < 0)
			std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(in), length, out.begin() + static_cast<std::ptrdiff_t>(filled));
		else
			std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(filled), length, packed[in]);
		in += stored;
		filled += length;
	}
	return filled == out.size();
}

// Undoes what OpenEXR does before RLE and zlib: bytes are differences, even ones in the first half, odd ones in the second.
static std::vector<std::byte> unfiltered(std::vector<std::byte> bytes)
{
	for (size_t i = 1; i < bytes.size(); ++i)
		bytes[i] = static_cast<std::byte>(std::to_integer<int>(bytes[i - 1]) + std::to_integer<int>(bytes[i]) - 128);
	std::vector<std::byte> result(bytes.size());
	const size_t half = (bytes.size() + 1) / 2;
	for (size_t i = 0; i < bytes.size(); ++i)
		result[i] = bytes[i % 2 == 0 ? i / 2 : half + i / 2];
	return result;
}

static std::optional<std::vector<std::byte>> expandBlock(std::span<const std::byte> stored, size_t wanted_bytes, uint8_t compression)
{
	// A block that compression would not make smaller is stored as it is.
	if (stored.size() == wanted_bytes)
		return std::vector<std::byte>(stored.begin(), stored.end());
	std::vector<std::byte> bytes(wanted_bytes);
	const bool expanded = compression == kRle ? expandRuns(stored, bytes) : compression != kNone && inflateExactly(stored, bytes);
	if (!expanded)
		return {};
	return unfiltered(std::move(bytes));
}

static float halfToFloat(uint32_t half)
{
	const uint32_t sign = (half & 0x8000u) << 16;
	const uint32_t exponent = half >> 10 & 31u;
	const uint32_t mantissa = half & 1023u;
	if (exponent == 0)
	{
		const float magnitude = static_cast<float>(mantissa) * 0x1p-24f;
		return sign ? -magnitude : magnitude;
	}
	return std::bit_cast<float>(sign | (exponent == 31 ? 255u : exponent + 112u) << 23 | mantissa << 13);
}

// Writes the chosen channels of the lines in `block` to `out`, where the first of these lines starts.
static void storeLines(const ExrHeader& header, std::span<const ExrChannel* const> chosen, std::span<const std::byte> block, float* out)
{
	const size_t line_count = block.size() / (header.width * header.pixel_bytes);
	for (size_t line = 0; line < line_count; ++line)
		for (size_t c = 0; c < chosen.size(); ++c)
		{
			const size_t size = chosen[c]->size();
			const std::byte* samples = block.data() + header.width * (line * header.pixel_bytes + chosen[c]->bytes_before);
			for (size_t x = 0; x < header.width; ++x)
			{
				const uint32_t bits = static_cast<uint32_t>(ByteReader({ samples + x * size, size }).number(size));
				out[(line * header.width + x) * chosen.size() + c] = size == 2 ? halfToFloat(bits) : std::bit_cast<float>(bits);
			}
		}
}

// Decodes every block of the table that `reader` stands at. Each must start at its own multiple of the lines per block.
static Status readBlocks(std::span<const std::byte> bytes, ByteReader& reader, const ExrHeader& header, const std::string& name,
						 std::span<const ExrChannel* const> chosen, Image& image)
{
	float* out = reinterpret_cast<float*>(image.texels.data());
	const size_t lines = header.linesPerBlock();
	const size_t block_count = (header.height + lines - 1) / lines;
	std::vector<bool> done(block_count, false);
	for (size_t i = 0; i < block_count; ++i)
	{
		const uint64_t offset = reader.number(8);
		if (reader.failed() || offset >= bytes.size())
			return badInput("{}: block {} of {} lies outside the file", name, i, block_count);
		ByteReader block(bytes, offset);
		const int64_t line = int64_t(block.i32()) - header.first_y;
		const std::span<const std::byte> stored = block.take(block.u32());
		if (block.failed() || line < 0 || line >= static_cast<int64_t>(header.height) || static_cast<size_t>(line) % lines != 0 ||
			done[static_cast<size_t>(line) / lines])
			return badInput("{}: block {} of {} is cut short or misplaced", name, i, block_count);
		const size_t first_line = static_cast<size_t>(line);
		done[first_line / lines] = true;
		const size_t wanted_bytes = std::min(lines, header.height - first_line) * header.width * header.pixel_bytes;
		const std::optional<std::vector<std::byte>> expanded = expandBlock(stored, wanted_bytes, header.compression);
		if (!expanded)
			return badInput("{}: block {} of {} cannot be decompressed", name, i, block_count);
		storeLines(header, chosen, *expanded, out + first_line * header.width * chosen.size());
	}
	return {};
}

Result<Image> decodeExr(std::span<const std::byte> bytes, const std::string& name)
{
	ByteReader reader(bytes);
	TRY_ASSIGN(const ExrHeader header, readHeader(reader, name));
	TRY_ASSIGN(const std::vector<const ExrChannel*> chosen, chooseChannels(header, name));
	// The table alone tells a file that is far too short for its size before the texels are allocated.
	if (reader.left() / 8 < (header.height + header.linesPerBlock() - 1) / header.linesPerBlock())
		return badInput("{}: is cut short in its block table", name);

	Image image;
	image.name = name;
	image.width = static_cast<uint32_t>(header.width);
	image.height = static_cast<uint32_t>(header.height);
	image.channels = static_cast<uint32_t>(chosen.size());
	image.format = TexelFormat::F32;
	image.texels.resize(header.width * header.height * chosen.size() * sizeof(float));
	TRY(readBlocks(bytes, reader, header, name, chosen, image));
	return image;
}

}  // namespace tessera
