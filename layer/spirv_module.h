// A SPIR-V module as a list of instructions, with what a rewrite looks for and adds.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tessera::layer::spirv
{

// Numbers of the SPIR-V specification (and of SPV_NV_cluster_acceleration_structure) that the layer meets.
enum Op : uint16_t
{
	OpName = 5,
	OpExtension = 10,
	OpExtInstImport = 11,
	OpMemoryModel = 14,
	OpEntryPoint = 15,
	OpCapability = 17,
	OpTypeVoid = 19,
	OpTypeInt = 21,
	OpTypeVector = 23,
	OpTypeRuntimeArray = 29,
	OpTypeStruct = 30,
	OpTypePointer = 32,
	OpTypeFunction = 33,
	OpTypeForwardPointer = 39,
	OpConstantTrue = 41,
	OpConstant = 43,
	OpConstantComposite = 44,
	OpSpecConstantOp = 52,
	OpFunction = 54,
	OpFunctionParameter = 55,
	OpFunctionEnd = 56,
	OpFunctionCall = 57,
	OpVariable = 59,
	OpLoad = 61,
	OpCopyMemory = 63,
	OpAccessChain = 65,
	OpDecorate = 71,
	OpMemberDecorate = 72,
	OpCompositeExtract = 81,
	OpBitcast = 124,
	OpIAdd = 128,
	OpIMul = 132,
	OpLabel = 248,
	OpReturnValue = 254,
	OpTraceRay = 4445,
	OpRayQueryClusterId = 5345,
	OpRayQueryCustomIndex = 6019,
	OpRayQueryGeometryIndex = 6022,
	OpRayQueryPrimitiveIndex = 6023,
};

enum Number : uint32_t
{
	StorageInput = 1,
	StoragePhysical = 5349,
	DecorationBlock = 2,
	DecorationArrayStride = 6,
	DecorationBuiltIn = 11,
	DecorationOffset = 35,
	BuiltInPrimitiveId = 7,
	BuiltInCustomIndex = 5327,
	BuiltInGeometryIndex = 5352,
	BuiltInClusterId = 5436,
	CapabilityPhysicalAddresses = 5347,
	CapabilityCluster = 5437,
	AddressingPhysical64 = 5348,
	ModelIntersection = 5314,
	ModelAnyHit = 5315,
	ModelClosestHit = 5316,
};

struct Instruction
{
	Op op = OpName;
	std::vector<uint32_t> words;  // operands, without the first word
};

struct Module
{
	uint32_t version = 0, generator = 0, bound = 0, schema = 0;
	std::vector<Instruction> code;

	uint32_t newId() { return bound++; }
	std::vector<uint32_t> words() const;
};

// Nothing when the words are no module.
std::optional<Module> parse(std::span<const uint32_t> words);

// Words of a string operand, and how many a string takes up.
std::vector<uint32_t> stringWords(const char* text);
size_t stringLength(std::span<const uint32_t> words);

}  // namespace tessera::layer::spirv
