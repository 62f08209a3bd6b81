#include "spirv_module.h"

#include "base/check.h"
#include "base/file.h"

#include <cstring>

namespace tessera::test
{

namespace
{

constexpr uint32_t kMagic = 0x07230203;
enum : uint32_t
{
	OpName = 5,
	OpMemberName = 6,
	OpExecutionMode = 16,
	OpTypeRuntimeArray = 29,
	OpTypeStruct = 30,
	OpFunction = 54,
	OpFunctionEnd = 56,
	OpDecorate = 71,
	OpMemberDecorate = 72,
};
enum : uint32_t
{
	DecorationArrayStride = 6,
	DecorationOffset = 35,
	DecorationNoContraction = 42,
};

std::string textOf(const SpirvInstruction& instruction, size_t first_operand)
{
	std::string text(reinterpret_cast<const char*>(instruction.operands.data() + first_operand),
					 (instruction.operands.size() - first_operand) * sizeof(uint32_t));
	return text.substr(0, text.find('\0'));
}

// Collects what instructions say about ids, in whatever order they come.
struct Reader
{
	SpirvModule module;
	std::map<uint32_t, std::string> names;
	std::map<uint32_t, std::map<uint32_t, std::string>> member_names;
	std::map<uint32_t, std::map<uint32_t, uint32_t>> member_offsets;
	std::map<uint32_t, size_t> struct_members;
	std::map<uint32_t, uint32_t> array_elements, array_strides;
	bool in_function = false;

	void decorate(const SpirvInstruction& instruction)
	{
		const std::vector<uint32_t>& o = instruction.operands;
		if (o[1] == DecorationNoContraction)
		{
			module.no_contraction.insert(o[0]);
			module.no_contraction_words[o[0]] = instruction.first_word;
		}
		if (o[1] == DecorationArrayStride)
			array_strides[o[0]] = o[2];
	}

	void read(const SpirvInstruction& instruction)
	{
		const std::vector<uint32_t>& o = instruction.operands;
		switch (instruction.opcode)
		{
		case OpName:
			names[o[0]] = textOf(instruction, 1);
			break;
		case OpMemberName:
			member_names[o[0]][o[1]] = textOf(instruction, 2);
			break;
		case OpExecutionMode:
			module.modes.insert({ o[1], o.size() > 2 ? o[2] : 0 });
			break;
		case OpTypeRuntimeArray:
			array_elements[o[0]] = o[1];
			break;
		case OpTypeStruct:
			struct_members[o[0]] = o.size() - 1;
			break;
		case OpDecorate:
			decorate(instruction);
			break;
		case OpMemberDecorate:
			if (o[2] == DecorationOffset)
				member_offsets[o[0]][o[1]] = o[3];
			break;
		case OpFunction:
			module.functions.push_back({ names[o[1]].substr(0, names[o[1]].find('(')), {} });
			in_function = true;
			break;
		case OpFunctionEnd:
			in_function = false;
			break;
		default:
			if (in_function)
				module.functions.back().body.push_back(instruction);
		}
	}

	void finishStructs()
	{
		for (const auto& [id, count] : struct_members)
		{
			SpirvStruct made = { names[id], std::vector<std::string>(count), std::vector<std::optional<uint32_t>>(count), {} };
			for (uint32_t member = 0; member < count; ++member)
			{
				made.members[member] = member_names[id][member];
				if (const auto found = member_offsets[id].find(member); found != member_offsets[id].end())
					made.offsets[member] = found->second;
			}
			for (const auto& [array, element] : array_elements)
				if (element == id)
					made.stride = array_strides[array];
			module.structs.push_back(std::move(made));
		}
	}
};

}  // namespace

SpirvModule readSpirv(const std::vector<uint32_t>& words, const std::string& file)
{
	CHECK(words.size() > 5 && words[0] == kMagic, "{}: no SPIR-V", file);
	Reader reader;
	reader.module.file = file;
	for (size_t at = 5; at < words.size();)
	{
		const size_t length = words[at] >> 16;
		CHECK(length > 0 && at + length <= words.size(), "{}: word {}: {} words do not fit", file, at, length);
		reader.read({ words[at] & 0xffffu, at, std::vector<uint32_t>(words.begin() + at + 1, words.begin() + at + length) });
		at += length;
	}
	reader.finishStructs();
	return std::move(reader.module);
}

std::vector<uint32_t> spirvWords(const std::filesystem::path& path)
{
	const Result<std::vector<std::byte>> bytes = readFile(path);
	CHECK(bytes.has_value(), "{}", bytes.error().message);
	std::vector<uint32_t> words(bytes->size() / sizeof(uint32_t));
	std::memcpy(words.data(), bytes->data(), words.size() * sizeof(uint32_t));
	return words;
}

}  // namespace tessera::test
