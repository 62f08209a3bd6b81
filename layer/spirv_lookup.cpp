#include "layer/spirv_lookup.h"

#include <algorithm>

namespace tessera::layer::spirv
{

namespace
{

// The tables, in the order of their addresses at the root.
enum Table : uint32_t
{
	kSlots,
	kRows,
	kGeometryIndices,
};

}  // namespace

LookupCode::LookupCode(Module& module, uint64_t root) : module_(module)
{
	declareTables(root);
	for (size_t i = 0; i < size_t(Wanted::Count); ++i)
		defineFunction(static_cast<Wanted>(i));
}

uint32_t LookupCode::add(std::vector<Instruction>& to, Op op, std::vector<uint32_t> before, std::vector<uint32_t> after)
{
	const uint32_t id = module_.newId();
	before.push_back(id);
	before.insert(before.end(), after.begin(), after.end());
	to.push_back({ op, std::move(before) });
	return id;
}

// Numbers, vectors and functions must not be declared twice; pointers and structures may.
uint32_t LookupCode::type(Op op, std::vector<uint32_t> operands)
{
	const auto same = [&](const Instruction& one) {
		return one.op == op && one.words.size() == operands.size() + 1 && std::equal(operands.begin(), operands.end(), one.words.begin() + 1);
	};
	if (op == OpTypeInt || op == OpTypeVector || op == OpTypeFunction)
		for (const std::vector<Instruction>* list : { &module_.code, &declarations })
			if (const auto found = std::find_if(list->begin(), list->end(), same); found != list->end())
				return found->words[0];
	return add(declarations, op, {}, std::move(operands));
}

uint32_t LookupCode::arrayPointer(uint32_t element, uint32_t stride)
{
	const uint32_t array = type(OpTypeRuntimeArray, { element }), block = type(OpTypeStruct, { array });
	decorations.push_back({ OpDecorate, { array, DecorationArrayStride, stride } });
	decorations.push_back({ OpDecorate, { block, DecorationBlock } });
	decorations.push_back({ OpMemberDecorate, { block, 0, DecorationOffset, 0 } });
	return type(OpTypePointer, { StoragePhysical, block });
}

void LookupCode::declareTables(uint64_t root)
{
	uint_ = type(OpTypeInt, { 32, 0 });
	uint4_ = type(OpTypeVector, { uint_, 4 });
	records_pointer_ = arrayPointer(uint4_, 16);
	records_place_ = type(OpTypePointer, { StoragePhysical, records_pointer_ });
	record_pointer_ = type(OpTypePointer, { StoragePhysical, uint4_ });
	indices_pointer_ = arrayPointer(uint_, 4);
	indices_place_ = type(OpTypePointer, { StoragePhysical, indices_pointer_ });
	index_pointer_ = type(OpTypePointer, { StoragePhysical, uint_ });
	const uint32_t block = type(OpTypeStruct, { records_pointer_, records_pointer_, indices_pointer_ });
	decorations.push_back({ OpDecorate, { block, DecorationBlock } });
	for (uint32_t member = 0; member < 3; ++member)
		decorations.push_back({ OpMemberDecorate, { block, member, DecorationOffset, 8 * member } });
	root_pointer_ = type(OpTypePointer, { StoragePhysical, block });
	const uint32_t uint2 = type(OpTypeVector, { uint_, 2 });
	root_address_ = add(declarations, OpConstantComposite, { uint2 }, { constant(uint32_t(root)), constant(uint32_t(root >> 32)) });
	function_type_ = type(OpTypeFunction, { uint_, uint_, uint_, uint_ });
}

// A record of a table: four numbers, or one of the geometry indices.
uint32_t LookupCode::load(uint32_t table, uint32_t index)
{
	constexpr uint32_t kAligned = 2;  // a memory operand, followed by the alignment
	const bool indices = table == kGeometryIndices;
	const uint32_t root = add(bodies, OpBitcast, { root_pointer_ }, { root_address_ });
	const uint32_t place = add(bodies, OpAccessChain, { indices ? indices_place_ : records_place_ }, { root, constant(table) });
	const uint32_t array = add(bodies, OpLoad, { indices ? indices_pointer_ : records_pointer_ }, { place, kAligned, 8 });
	const uint32_t record = add(bodies, OpAccessChain, { indices ? index_pointer_ : record_pointer_ }, { array, constant(0), index });
	return add(bodies, OpLoad, { indices ? uint_ : uint4_ }, { record, kAligned, indices ? 4u : 16u });
}

// a + b * c
uint32_t LookupCode::sumOfProduct(uint32_t a, uint32_t b, uint32_t c)
{
	const uint32_t product = add(bodies, OpIMul, { uint_ }, { b, c });
	return add(bodies, OpIAdd, { uint_ }, { a, product });
}

// See Slot and Row for what the members are.
void LookupCode::defineFunction(Wanted wanted)
{
	constexpr uint32_t kNoControl = 0;
	functions_[wanted] = add(bodies, OpFunction, { uint_ }, { kNoControl, function_type_ });
	const uint32_t slot_number = add(bodies, OpFunctionParameter, { uint_ }, {});
	const uint32_t geometry = add(bodies, OpFunctionParameter, { uint_ }, {});
	const uint32_t primitive = add(bodies, OpFunctionParameter, { uint_ }, {});
	add(bodies, OpLabel, {}, {});
	const uint32_t slot = load(kSlots, slot_number);
	uint32_t value = extract(slot, 0);
	if (wanted != Wanted::CustomIndex)
	{
		const uint32_t row = load(kRows, sumOfProduct(extract(slot, 1), geometry, extract(slot, 2)));
		value = extract(row, 0);
		if (wanted == Wanted::GeometryIndex)
			value = sumOfProduct(load(kGeometryIndices, sumOfProduct(extract(row, 1), primitive, extract(row, 2))), geometry, extract(slot, 3));
	}
	bodies.push_back({ OpReturnValue, { value } });
	bodies.push_back({ OpFunctionEnd, {} });
}

}  // namespace tessera::layer::spirv
