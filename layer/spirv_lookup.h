// Look-ups in the layer's tables as SPIR-V: types, constants and functions that a rewritten module gets.
#pragma once
#include "layer/spirv_module.h"

#include <map>

namespace tessera::layer::spirv
{

// What is read of a hit; each has a function that answers it.
enum class Wanted
{
	CustomIndex,
	GeometryIndex,
	ClusterId,
	Count,
};

class LookupCode
{
public:
	// `root`: the address that LookupTable::root() returns.
	LookupCode(Module& module, uint64_t root);

	// Adds an instruction with a new result id, which stands between the two groups of operands, and returns the id.
	uint32_t add(std::vector<Instruction>& to, Op op, std::vector<uint32_t> before, std::vector<uint32_t> after);
	// A type, the module's own where there is one that must not be declared twice.
	uint32_t type(Op op, std::vector<uint32_t> operands);
	uint32_t uintType() const { return uint_; }
	// uint f(slot, geometry, primitive).
	uint32_t function(Wanted wanted) const { return functions_.at(wanted); }

	// To be put before the module's declarations, before its functions, and at its end.
	std::vector<Instruction> decorations, declarations, bodies;

private:
	void declareTables(uint64_t root);
	void defineFunction(Wanted wanted);
	uint32_t constant(uint32_t value) { return add(declarations, OpConstant, { uint_ }, { value }); }
	uint32_t arrayPointer(uint32_t element, uint32_t stride);
	uint32_t load(uint32_t table, uint32_t index);
	uint32_t extract(uint32_t composite, uint32_t member) { return add(bodies, OpCompositeExtract, { uint_ }, { composite, member }); }
	uint32_t sumOfProduct(uint32_t a, uint32_t b, uint32_t c);

	Module& module_;
	std::map<Wanted, uint32_t> functions_;
	uint32_t uint_ = 0, uint4_ = 0, function_type_ = 0, root_address_ = 0, root_pointer_ = 0;
	// Pointers to a table, to where that pointer stands, and to one of its records.
	uint32_t records_pointer_ = 0, records_place_ = 0, record_pointer_ = 0;
	uint32_t indices_pointer_ = 0, indices_place_ = 0, index_pointer_ = 0;
};

}  // namespace tessera::layer::spirv
