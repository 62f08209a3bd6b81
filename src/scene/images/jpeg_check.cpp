#include "scene/images/jpeg_check.h"

#include <algorithm>

namespace tessera
{

namespace
{

constexpr uint32_t kStart = 0xd8, kEnd = 0xd9, kFirstRestart = 0xd0, kLastRestart = 0xd7, kHuffmanTables = 0xc4;
constexpr uint32_t kMostCodes = 256;

class JpegWalk
{
public:
	explicit JpegWalk(std::span<const std::byte> bytes) : bytes_(bytes) {}

	// The next marker that is not within coded data; kEnd where there is none.
	uint32_t nextMarker()
	{
		for (; at_ + 1 < bytes_.size(); ++at_)
		{
			const uint32_t code = byte(at_ + 1);
			if (byte(at_) != 0xff || code == 0 || code == 0xff || (code >= kFirstRestart && code <= kLastRestart))
				continue;
			at_ += 2;
			return code;
		}
		return kEnd;
	}

	// Goes on behind the segment here; returns what its length leaves for content, 0 where that is nonsense.
	size_t skipSegment()
	{
		const size_t length = at_ + 2 <= bytes_.size() ? byte(at_) << 8 | byte(at_ + 1) : 0;
		content_ = std::min(at_ + 2, bytes_.size());
		at_ = std::min(at_ + std::max<size_t>(length, 2), bytes_.size());
		return length < 2 ? 0 : length - 2;
	}

	// Everything from the last segment's content to the end of the file.
	std::span<const std::byte> fromContent() const { return bytes_.subspan(content_); }

private:
	uint32_t byte(size_t i) const { return std::to_integer<uint32_t>(bytes_[i]); }

	std::span<const std::byte> bytes_;
	size_t at_ = 0, content_ = 0;
};

// Number of codes of the largest table among those that begin within the next `length` bytes. The last one may reach beyond them: the
// decoder reads it whole before it notices.
uint32_t largestTable(std::span<const std::byte> bytes, size_t length)
{
	constexpr size_t kHead = 17;  // which table, then the number of codes of each length from 1 to 16
	uint32_t largest = 0;
	for (size_t at = 0; at < length && at + 1 < bytes.size();)
	{
		uint32_t codes = 0;
		for (const std::byte count : bytes.subspan(at + 1, std::min(kHead - 1, bytes.size() - at - 1)))
			codes += std::to_integer<uint32_t>(count);
		largest = std::max(largest, codes);
		at += kHead + codes;
	}
	return largest;
}

}  // namespace

Status checkJpeg(std::span<const std::byte> bytes, const std::string& name)
{
	JpegWalk walk(bytes);
	if (walk.nextMarker() != kStart)
		return {};
	for (uint32_t marker = walk.nextMarker(); marker != kEnd; marker = walk.nextMarker())
	{
		const size_t length = walk.skipSegment();
		if (marker != kHuffmanTables)
			continue;
		if (const uint32_t codes = largestTable(walk.fromContent(), length); codes > kMostCodes)
			return badInput("{}: cannot be decoded: a Huffman table has {} codes, at most {} are right", name, codes, kMostCodes);
	}
	return {};
}

}  // namespace tessera
