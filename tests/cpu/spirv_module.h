// A SPIR-V module read just as far as tests need it: names, layouts, decorations, and what functions compute.
// Source: Khronos, SPIR-V Specification 1.6, sections 2.3 (physical layout) and 3 (binary form).
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tessera::test
{

struct SpirvInstruction
{
	uint32_t opcode = 0;
	size_t first_word = 0;           // in the module, of the instruction
	std::vector<uint32_t> operands;  // all words after the first
};

struct SpirvFunction
{
	std::string name;  // as written in the source, without parameters
	std::vector<SpirvInstruction> body;
};

struct SpirvStruct
{
	std::string name;
	std::vector<std::string> members;
	std::vector<std::optional<uint32_t>> offsets;  // empty where the struct is no buffer's
	std::optional<uint32_t> stride;                // of runtime arrays of it
};

struct SpirvModule
{
	std::string file;
	std::vector<SpirvStruct> structs;  // a name appears once per layout
	std::vector<SpirvFunction> functions;
	std::set<uint32_t> no_contraction;                // results decorated so
	std::map<uint32_t, size_t> no_contraction_words;  // and where in the module
	std::set<std::pair<uint32_t, uint32_t>> modes;    // execution modes with their first operand
};

// Opcodes and numbers that tests name.
inline constexpr uint32_t kOpExtInst = 12, kOpFAdd = 129, kOpFSub = 131, kOpFMul = 133, kOpFDiv = 136;
inline constexpr uint32_t kModeSignedZeroInfNanPreserve = 4461, kModeRoundingRte = 4462;

// A failed CHECK when the words are no SPIR-V.
SpirvModule readSpirv(const std::vector<uint32_t>& words, const std::string& file);
std::vector<uint32_t> spirvWords(const std::filesystem::path& path);

}  // namespace tessera::test
