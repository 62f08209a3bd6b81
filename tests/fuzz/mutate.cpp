#include "mutate.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <random>

namespace tessera::test
{

namespace
{

using Json = nlohmann::ordered_json;
using Bytes = std::vector<uint8_t>;

constexpr size_t kHeader = 12, kChunkHeader = 8;

uint32_t readU32(std::span<const uint8_t> bytes, size_t at)
{
	uint32_t value = 0;
	std::memcpy(&value, bytes.data() + at, 4);
	return value;
}

void putU32(Bytes& bytes, uint32_t value)
{
	const auto* first = reinterpret_cast<const uint8_t*>(&value);
	bytes.insert(bytes.end(), first, first + 4);
}

struct Glb
{
	Bytes json, binary;
};

bool split(std::span<const uint8_t> file, Glb& glb)
{
	if (file.size() < kHeader + kChunkHeader || std::memcmp(file.data(), "glTF", 4) != 0)
		return false;
	const size_t json_size = readU32(file, 12), json_end = kHeader + kChunkHeader + json_size;
	if (json_end > file.size())
		return false;
	glb.json.assign(file.begin() + kHeader + kChunkHeader, file.begin() + static_cast<std::ptrdiff_t>(json_end));
	if (json_end + kChunkHeader <= file.size())
		glb.binary.assign(file.begin() + static_cast<std::ptrdiff_t>(json_end + kChunkHeader), file.end());
	return true;
}

Bytes joined(Glb glb)
{
	glb.json.resize((glb.json.size() + 3) / 4 * 4, ' ');
	glb.binary.resize((glb.binary.size() + 3) / 4 * 4);
	Bytes file;
	for (const uint32_t word :
		 { 0x46546c67u, 2u, uint32_t(kHeader + 2 * kChunkHeader + glb.json.size() + glb.binary.size()), uint32_t(glb.json.size()), 0x4e4f534au })
		putU32(file, word);
	file.insert(file.end(), glb.json.begin(), glb.json.end());
	putU32(file, uint32_t(glb.binary.size()));
	putU32(file, 0x004e4942);
	file.insert(file.end(), glb.binary.begin(), glb.binary.end());
	return file;
}

// Every value of a description, itself included.
void listValues(Json& json, std::vector<Json*>& values)
{
	values.push_back(&json);
	if (json.is_structured())
		for (Json& child : json)
			listValues(child, values);
}

Json interestingNumber(std::mt19937& random, const Json& before)
{
	static const Json kNumbers[] = { 0,
									 1,
									 2,
									 3,
									 4,
									 255,
									 256,
									 65535,
									 65536,
									 16777216,
									 2147483647,
									 2147483648u,
									 4294967295u,
									 4294967296ull,
									 18446744073709551615ull,
									 -1,
									 -2147483648ll,
									 0.5,
									 -0.0,
									 1e-40,
									 1e-9,
									 1e9,
									 1e30,
									 3.5e38,
									 1e308,
									 5120,
									 5121,
									 5122,
									 5123,
									 5125,
									 5126 };
	if (before.is_number_integer() && random() % 2 == 0)
		return before.get<int64_t>() + int64_t(random() % 9) - 4;
	return kNumbers[random() % std::size(kNumbers)];
}

void mutateValue(Json& root, std::mt19937& random)
{
	std::vector<Json*> values;
	listValues(root, values);
	Json& value = *values[random() % values.size()];
	const Json other = *values[random() % values.size()];
	const unsigned way = random() % 8;
	if (value.is_number() && way < 5)
		value = interestingNumber(random, value);
	else if (value.is_structured() && !value.empty() && way < 3)
		value.erase(std::next(value.begin(), long(random() % value.size())));
	else if (value.is_array() && !value.empty() && way < 5)
		value.push_back(Json(value[random() % value.size()]));
	else if (value.is_object() && !value.empty() && way < 5)
		value[std::next(value.begin(), long(random() % value.size())).key()] = other;
	else
		value = other;
}

bool mutateDescription(Bytes& text, std::mt19937& random)
{
	Json json = Json::parse(text.begin(), text.end(), nullptr, false);
	if (json.is_discarded())
		return false;
	for (unsigned i = 0; i <= random() % 3; ++i)
		mutateValue(json, random);
	const std::string changed = json.dump(-1, ' ', false, Json::error_handler_t::replace);
	text.assign(changed.begin(), changed.end());
	return true;
}

void mutateBytes(Bytes& data, size_t room, const ByteMutator& bytes)
{
	const size_t size = data.size(), most = std::max<size_t>(1, size + std::min<size_t>(room, 64));
	data.resize(most);
	data.resize(bytes(data.data(), size, most));
}

}  // namespace

std::vector<uint8_t> mutateGltf(std::span<const uint8_t> file, size_t most, uint32_t seed, const ByteMutator& bytes)
{
	std::mt19937 random(seed);
	Bytes whole(file.begin(), file.end());
	const size_t room = most > file.size() ? most - file.size() : 0;
	Glb glb;
	const bool is_glb = split(file, glb);
	const unsigned way = random() % 16;
	if (is_glb && way >= 2)
	{
		if (way >= 9 || !mutateDescription(glb.json, random))
			mutateBytes(way >= 9 && !glb.binary.empty() ? glb.binary : glb.json, room, bytes);
		whole = joined(std::move(glb));
	}
	else if (is_glb || way < 6 || !mutateDescription(whole, random))
		mutateBytes(whole, room, bytes);
	if (whole.size() > most)
		whole.resize(most);
	return whole;
}

}  // namespace tessera::test
