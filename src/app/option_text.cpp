#include "app/option_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tessera
{

namespace
{

template <typename Number>
std::optional<Number> readWhole(std::string_view text)
{
	Number value = {};
	const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
	if (text.empty() || code != std::errc() || end != text.data() + text.size())
		return std::nullopt;
	return value;
}

}  // namespace

std::optional<uint32_t> readCount(std::string_view text, uint32_t least, uint32_t most)
{
	const std::optional<uint32_t> value = readWhole<uint32_t>(text);
	return value && *value >= least && *value <= most ? value : std::nullopt;
}

std::optional<double> readNumber(std::string_view text)
{
	const std::optional<double> value = readWhole<double>(text);
	return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<std::string_view> splitAt(std::string_view text, char separator)
{
	std::vector<std::string_view> parts;
	for (size_t end = text.find(separator); end != std::string_view::npos; end = text.find(separator))
	{
		parts.push_back(text.substr(0, end));
		text.remove_prefix(end + 1);
	}
	parts.push_back(text);
	return parts;
}

std::optional<std::array<uint32_t, 2>> readPair(std::string_view text, uint32_t least, uint32_t most)
{
	const std::vector<std::string_view> parts = splitAt(text, 'x');
	if (parts.size() != 2)
		return std::nullopt;
	const std::optional<uint32_t> first = readCount(parts[0], least, most), second = readCount(parts[1], least, most);
	if (!first || !second)
		return std::nullopt;
	return std::array{ *first, *second };
}

std::optional<dvec3> readVector(std::string_view text)
{
	const std::vector<std::string_view> parts = splitAt(text, ',');
	if (parts.size() != 3)
		return std::nullopt;
	dvec3 vector;
	for (int axis = 0; axis < 3; ++axis)
	{
		const std::optional<double> number = readNumber(parts[static_cast<size_t>(axis)]);
		if (!number)
			return std::nullopt;
		vector[axis] = *number;
	}
	return vector;
}

std::string printVector(const dvec3& vector)
{
	return fmt::format("{},{},{}", vector.x, vector.y, vector.z);
}

namespace
{

struct ByteUnit
{
	std::string_view name;
	uint64_t bytes;
};
// Names that end in others come first; printing takes the decimal ones, largest first.
constexpr ByteUnit kByteUnits[] = {
	{ "KiB", 1ull << 10 }, { "MiB", 1ull << 20 }, { "GiB", 1ull << 30 }, { "GB", 1'000'000'000 }, { "MB", 1'000'000 }, { "kB", 1000 }, { "B", 1 },
};
constexpr size_t kFirstDecimal = 3;

}  // namespace

std::optional<uint64_t> readBytes(std::string_view text)
{
	const auto unit = std::find_if(std::begin(kByteUnits), std::end(kByteUnits), [&](const ByteUnit& u) { return text.ends_with(u.name); });
	if (unit != std::end(kByteUnits))
		text.remove_suffix(unit->name.size());
	const std::optional<double> number = readNumber(text);
	if (!number)
		return std::nullopt;
	const double bytes = std::round(*number * double(unit != std::end(kByteUnits) ? unit->bytes : 1));
	return bytes >= 1 && bytes <= 0x1p50 ? std::optional(static_cast<uint64_t>(bytes)) : std::nullopt;
}

std::string printBytes(uint64_t bytes)
{
	const auto unit =
		std::find_if(std::begin(kByteUnits) + kFirstDecimal, std::end(kByteUnits), [&](const ByteUnit& u) { return bytes % u.bytes == 0; });
	return fmt::format("{}{}", bytes / unit->bytes, unit->name);
}

std::string counted(uint64_t count, std::string_view noun)
{
	return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

double shortest(float value)
{
	return readNumber(fmt::format("{}", value)).value_or(double(value));
}

}  // namespace tessera
