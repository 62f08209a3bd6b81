// Numbers and tuples as the command line writes them. Errors say what would be right, without the option's name.
#pragma once
#include "base/result.h"
#include "base/vec.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera
{

// A whole number of the range, or nothing: no sign, no blanks, nothing after it.
std::optional<uint32_t> readCount(std::string_view text, uint32_t least, uint32_t most);

// A finite number with nothing after it.
std::optional<double> readNumber(std::string_view text);

// "4x3": two whole numbers, each of the range.
std::optional<std::array<uint32_t, 2>> readPair(std::string_view text, uint32_t least, uint32_t most);

// "x,y,z": three finite numbers.
std::optional<dvec3> readVector(std::string_view text);
std::string printVector(const dvec3& vector);

std::vector<std::string_view> splitAt(std::string_view text, char separator);

// "64MB": a number and one of B, kB, MB, GB, KiB, MiB, GiB; no unit is B. Rounded to whole bytes, 1 to 2^50.
std::optional<uint64_t> readBytes(std::string_view text);
// The same back, with the largest decimal unit that leaves a whole number.
std::string printBytes(uint64_t bytes);

template <typename Names>
std::string joinNames(const Names& names)
{
	std::string text;
	for (const auto& name : names)
	{
		text += text.empty() ? "" : ", ";
		text += name;
	}
	return text;
}

// "1 cluster", "2 clusters".
std::string counted(uint64_t count, std::string_view noun);

// As short as it can be while reading back as the same float.
double shortest(float value);

}  // namespace tessera
