#include "layer/spirv_module.h"

#include <cstring>

namespace tessera::layer::spirv
{

std::vector<uint32_t> Module::words() const
{
	std::vector<uint32_t> out = { 0x07230203u, version, generator, bound, schema };
	for (const Instruction& instruction : code)
	{
		out.push_back(uint32_t(instruction.words.size() + 1) << 16 | instruction.op);
		out.insert(out.end(), instruction.words.begin(), instruction.words.end());
	}
	return out;
}

std::optional<Module> parse(std::span<const uint32_t> words)
{
	if (words.size() < 5 || words[0] != 0x07230203u)
		return std::nullopt;
	Module module = { words[1], words[2], words[3], words[4], {} };
	for (size_t at = 5; at < words.size();)
	{
		const size_t length = words[at] >> 16;
		if (length == 0 || length > words.size() - at)
			return std::nullopt;
		const auto operands = words.subspan(at + 1, length - 1);
		module.code.push_back({ static_cast<Op>(words[at] & 0xffffu), { operands.begin(), operands.end() } });
		at += length;
	}
	return module;
}

std::vector<uint32_t> stringWords(const char* text)
{
	std::vector<uint32_t> words(std::strlen(text) / 4 + 1);
	std::memcpy(words.data(), text, std::strlen(text));
	return words;
}

size_t stringLength(std::span<const uint32_t> words)
{
	for (size_t i = 0; i < words.size(); ++i)
		if ((words[i] & 0xff000000u) == 0)  // the end is in the word whose last byte is zero
			return i + 1;
	return words.size();
}

}  // namespace tessera::layer::spirv
