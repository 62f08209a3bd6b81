#include "gpu/spirv_constants.h"

#include <map>

namespace tessera
{

namespace
{

// SPIR-V specification, section 3.
constexpr uint32_t kHeaderWords = 5;
constexpr uint32_t kOpName = 5, kOpMemberName = 6, kOpEntryPoint = 15, kOpDecorate = 71, kOpMemberDecorate = 72;
constexpr uint32_t kOpSpecConstantTrue = 48, kOpSpecConstantFalse = 49, kOpSpecConstant = 50;
constexpr uint32_t kSpecId = 1;

// Calls `take(opcode, words)` for every instruction; words[0] is the instruction's first.
template <typename Take>
void forEachInstruction(std::span<const uint32_t> spirv, const Take& take)
{
	for (size_t at = kHeaderWords; at < spirv.size();)
	{
		const uint32_t count = spirv[at] >> 16;
		if (count == 0 || at + count > spirv.size())
			return;
		take(spirv[at] & 0xffffu, spirv.subspan(at, count));
		at += count;
	}
}

bool refersToNothing(uint32_t opcode)
{
	return opcode == kOpName || opcode == kOpMemberName || opcode == kOpEntryPoint || opcode == kOpDecorate || opcode == kOpMemberDecorate ||
		   opcode == kOpSpecConstantTrue || opcode == kOpSpecConstantFalse || opcode == kOpSpecConstant;
}

}  // namespace

std::set<uint32_t> usedConstants(std::span<const uint32_t> spirv)
{
	std::map<uint32_t, uint32_t> constant_of;  // result id to constant id
	forEachInstruction(spirv, [&](uint32_t opcode, std::span<const uint32_t> words) {
		if (opcode == kOpDecorate && words.size() == 4 && words[2] == kSpecId)
			constant_of[words[1]] = words[3];
	});
	std::set<uint32_t> used;
	forEachInstruction(spirv, [&](uint32_t opcode, std::span<const uint32_t> words) {
		if (refersToNothing(opcode))
			return;
		for (uint32_t word : words.subspan(1))
			if (const auto found = constant_of.find(word); found != constant_of.end())
				used.insert(found->second);
	});
	return used;
}

}  // namespace tessera
