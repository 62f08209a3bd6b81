// The rewrite: new functions at the module's end look things up; instructions that read one of the built-ins become calls of them.
#include "layer/spirv_rewrite.h"

#include "layer/spirv_module.h"

#include <algorithm>
#include <map>
#include <optional>

namespace tessera::layer
{

namespace
{

using namespace spirv;

// What is read of a hit; also which look-up function answers it.
enum class Wanted
{
	CustomIndex,
	GeometryIndex,
	ClusterId,
	Count,
};

struct Variable
{
	uint32_t id = 0, type = 0;  // the type it holds
};

class Rewrite
{
public:
	Rewrite(Module& module, VkDeviceAddress root) : module_(module), root_(root) {}
	Rewritten run();

private:
	void scan();
	bool reads() const;
	uint32_t type(Op op, std::vector<uint32_t> operands);
	uint32_t constant(uint32_t value);
	uint32_t add(std::vector<Instruction>& to, Op op, std::vector<uint32_t> operands_before, std::vector<uint32_t> operands_after);
	void declareTables();
	void declareInputs();
	uint32_t input(std::vector<Instruction>& to, uint32_t builtin);
	uint32_t queried(std::vector<Instruction>& to, Op op, const std::vector<uint32_t>& query);
	uint32_t loadRecord(std::vector<Instruction>& to, uint32_t table, uint32_t index, uint32_t value_type, uint32_t pointer_type, uint32_t alignment);
	uint32_t extract(std::vector<Instruction>& to, uint32_t composite, uint32_t member);
	uint32_t binary(std::vector<Instruction>& to, Op op, uint32_t a, uint32_t b);
	void defineFunction(Wanted wanted);
	void answer(std::vector<Instruction>& to, Wanted wanted, const Instruction& replaced, const std::vector<uint32_t>* query);
	void replaceReads();
	void fixDeclarations();

	Module& module_;
	VkDeviceAddress root_;
	Rewritten result_;
	std::map<uint32_t, uint32_t> pointees_;    // pointer type to what it points to
	std::map<uint32_t, Variable> by_builtin_;  // builtin to its input variable
	std::map<uint32_t, uint32_t> builtin_of_;  // variable to builtin
	std::map<Wanted, uint32_t> functions_;
	std::vector<Instruction> types_, decorations_, bodies_;
	std::vector<uint32_t> new_inputs_;
	bool has_queries_ = false;
	uint32_t uint_ = 0, uint4_ = 0, function_type_ = 0;
	uint32_t root_pointer_ = 0, records_pointer_ = 0, record_pointer_ = 0, indices_pointer_ = 0, index_pointer_ = 0, records_member_ = 0,
			 indices_member_ = 0, root_address_ = 0;
};

constexpr uint32_t kRewritten[] = { BuiltInCustomIndex, BuiltInGeometryIndex, BuiltInClusterId };

Wanted wantedOf(uint32_t builtin)
{
	return builtin == BuiltInCustomIndex ? Wanted::CustomIndex : builtin == BuiltInGeometryIndex ? Wanted::GeometryIndex : Wanted::ClusterId;
}

std::optional<Wanted> wantedOf(Op op)
{
	switch (op)
	{
	case OpRayQueryCustomIndex:
		return Wanted::CustomIndex;
	case OpRayQueryGeometryIndex:
		return Wanted::GeometryIndex;
	case OpRayQueryClusterId:
		return Wanted::ClusterId;
	default:
		return std::nullopt;
	}
}

void Rewrite::scan()
{
	for (const Instruction& one : module_.code)
	{
		const auto& words = one.words;
		if (one.op == OpDecorate && words.size() == 3 && words[1] == DecorationBuiltIn)
			builtin_of_[words[0]] = words[2];
		else if (one.op == OpTypePointer)
			pointees_[words[0]] = words[2];
		else if (one.op == OpVariable && builtin_of_.contains(words[1]) && words[2] == StorageInput)
			by_builtin_[builtin_of_[words[1]]] = { words[1], pointees_[words[0]] };
		else if (one.op == OpCapability && words[0] == CapabilityCluster)
			result_.says_so = true;
		else if (wantedOf(one.op))
			has_queries_ = true;
		result_.reads_cluster_id = result_.reads_cluster_id || one.op == OpRayQueryClusterId;
	}
	result_.reads_cluster_id = result_.reads_cluster_id || by_builtin_.contains(BuiltInClusterId);
}

bool Rewrite::reads() const
{
	return has_queries_ || result_.says_so ||
		   std::any_of(std::begin(kRewritten), std::end(kRewritten), [&](uint32_t builtin) { return by_builtin_.contains(builtin); });
}

uint32_t Rewrite::add(std::vector<Instruction>& to, Op op, std::vector<uint32_t> before, std::vector<uint32_t> after)
{
	const uint32_t id = module_.newId();
	before.push_back(id);
	before.insert(before.end(), after.begin(), after.end());
	to.push_back({ op, std::move(before) });
	return id;
}

// Numbers and vectors must not be declared twice; pointers and structures may.
uint32_t Rewrite::type(Op op, std::vector<uint32_t> operands)
{
	const auto same = [&](const Instruction& one) {
		return one.op == op && one.words.size() == operands.size() + 1 && std::equal(operands.begin(), operands.end(), one.words.begin() + 1);
	};
	if (op == OpTypeInt || op == OpTypeVector || op == OpTypeFunction)
		for (const std::vector<Instruction>* list : { &module_.code, &types_ })
			if (const auto found = std::find_if(list->begin(), list->end(), same); found != list->end())
				return found->words[0];
	return add(types_, op, {}, std::move(operands));
}

uint32_t Rewrite::constant(uint32_t value)
{
	return add(types_, OpConstant, { uint_ }, { value });
}

void Rewrite::declareTables()
{
	uint_ = type(OpTypeInt, { 32, 0 });
	uint4_ = type(OpTypeVector, { uint_, 4 });
	const auto arrayOf = [&](uint32_t element, uint32_t stride) {
		const uint32_t array = type(OpTypeRuntimeArray, { element }), block = type(OpTypeStruct, { array });
		decorations_.push_back({ OpDecorate, { array, DecorationArrayStride, stride } });
		decorations_.push_back({ OpDecorate, { block, DecorationBlock } });
		decorations_.push_back({ OpMemberDecorate, { block, 0, DecorationOffset, 0 } });
		return type(OpTypePointer, { StoragePhysical, block });
	};
	records_pointer_ = arrayOf(uint4_, 16);
	indices_pointer_ = arrayOf(uint_, 4);
	record_pointer_ = type(OpTypePointer, { StoragePhysical, uint4_ });
	index_pointer_ = type(OpTypePointer, { StoragePhysical, uint_ });
	records_member_ = type(OpTypePointer, { StoragePhysical, records_pointer_ });
	indices_member_ = type(OpTypePointer, { StoragePhysical, indices_pointer_ });
	const uint32_t root = type(OpTypeStruct, { records_pointer_, records_pointer_, indices_pointer_ });
	decorations_.push_back({ OpDecorate, { root, DecorationBlock } });
	for (uint32_t member = 0; member < 3; ++member)
		decorations_.push_back({ OpMemberDecorate, { root, member, DecorationOffset, 8 * member } });
	root_pointer_ = type(OpTypePointer, { StoragePhysical, root });
	const uint32_t uint2 = type(OpTypeVector, { uint_, 2 });
	root_address_ = add(types_, OpConstantComposite, { uint2 }, { constant(uint32_t(root_)), constant(uint32_t(root_ >> 32)) });
	function_type_ = type(OpTypeFunction, { uint_, uint_, uint_, uint_ });
}

// Variables for what the look-ups start from, where the module has none.
void Rewrite::declareInputs()
{
	if (std::none_of(std::begin(kRewritten), std::end(kRewritten), [&](uint32_t builtin) { return by_builtin_.contains(builtin); }))
		return;
	for (const uint32_t builtin : { uint32_t(BuiltInCustomIndex), uint32_t(BuiltInGeometryIndex), uint32_t(BuiltInPrimitiveId) })
		if (!by_builtin_.contains(builtin))
		{
			const uint32_t pointer = type(OpTypePointer, { StorageInput, uint_ });
			const uint32_t variable = add(types_, OpVariable, { pointer }, { StorageInput });
			decorations_.push_back({ OpDecorate, { variable, DecorationBuiltIn, builtin } });
			by_builtin_[builtin] = { variable, uint_ };
			new_inputs_.push_back(variable);
		}
}

// A built-in's value as an unsigned number.
uint32_t Rewrite::input(std::vector<Instruction>& to, uint32_t builtin)
{
	const Variable variable = by_builtin_.at(builtin);
	const uint32_t value = add(to, OpLoad, { variable.type }, { variable.id });
	return variable.type == uint_ ? value : add(to, OpBitcast, { uint_ }, { value });
}

// The same of a ray query: `query` has the query and which intersection is meant.
uint32_t Rewrite::queried(std::vector<Instruction>& to, Op op, const std::vector<uint32_t>& query)
{
	return add(to, op, { uint_ }, query);
}

uint32_t Rewrite::loadRecord(std::vector<Instruction>& to, uint32_t table, uint32_t index, uint32_t value_type, uint32_t pointer_type,
							 uint32_t alignment)
{
	constexpr uint32_t kAligned = 2;
	const bool indices = pointer_type == index_pointer_;
	const uint32_t root = add(to, OpBitcast, { root_pointer_ }, { root_address_ });
	const uint32_t member = add(to, OpAccessChain, { indices ? indices_member_ : records_member_ }, { root, constant(table) });
	const uint32_t array = add(to, OpLoad, { indices ? indices_pointer_ : records_pointer_ }, { member, kAligned, 8 });
	const uint32_t place = add(to, OpAccessChain, { pointer_type }, { array, constant(0), index });
	return add(to, OpLoad, { value_type }, { place, kAligned, alignment });
}

uint32_t Rewrite::extract(std::vector<Instruction>& to, uint32_t composite, uint32_t member)
{
	return add(to, OpCompositeExtract, { uint_ }, { composite, member });
}

uint32_t Rewrite::binary(std::vector<Instruction>& to, Op op, uint32_t a, uint32_t b)
{
	return add(to, op, { uint_ }, { a, b });
}

// uint f(slot, geometry, primitive); see Slot and Row.
void Rewrite::defineFunction(Wanted wanted)
{
	std::vector<Instruction>& to = bodies_;
	constexpr uint32_t kNone = 0;
	functions_[wanted] = add(to, OpFunction, { uint_ }, { kNone, function_type_ });
	const uint32_t slot_number = add(to, OpFunctionParameter, { uint_ }, {});
	const uint32_t geometry = add(to, OpFunctionParameter, { uint_ }, {});
	const uint32_t primitive = add(to, OpFunctionParameter, { uint_ }, {});
	add(to, OpLabel, {}, {});
	const uint32_t slot = loadRecord(to, 0, slot_number, uint4_, record_pointer_, 16);
	uint32_t value = extract(to, slot, 0);
	if (wanted != Wanted::CustomIndex)
	{
		const uint32_t row_number = binary(to, OpIAdd, extract(to, slot, 1), binary(to, OpIMul, geometry, extract(to, slot, 2)));
		const uint32_t row = loadRecord(to, 1, row_number, uint4_, record_pointer_, 16);
		value = extract(to, row, 0);
		if (wanted == Wanted::GeometryIndex)
		{
			const uint32_t place = binary(to, OpIAdd, extract(to, row, 1), binary(to, OpIMul, primitive, extract(to, row, 2)));
			const uint32_t index = loadRecord(to, 2, place, uint_, index_pointer_, 4);
			value = binary(to, OpIAdd, index, binary(to, OpIMul, geometry, extract(to, slot, 3)));
		}
	}
	to.push_back({ OpReturnValue, { value } });
	to.push_back({ OpFunctionEnd, {} });
}

// In place of an instruction that read it: the same result id, of the same type.
void Rewrite::answer(std::vector<Instruction>& to, Wanted wanted, const Instruction& replaced, const std::vector<uint32_t>* query)
{
	std::vector<uint32_t> arguments = { functions_.at(wanted) };
	if (query)
		for (const Op op : { OpRayQueryCustomIndex, OpRayQueryGeometryIndex, OpRayQueryPrimitiveIndex })
			arguments.push_back(queried(to, op, *query));
	else
		for (const uint32_t builtin : { uint32_t(BuiltInCustomIndex), uint32_t(BuiltInGeometryIndex), uint32_t(BuiltInPrimitiveId) })
			arguments.push_back(input(to, builtin));
	const uint32_t type = replaced.words[0], id = replaced.words[1];
	if (type == uint_)
	{
		std::vector<uint32_t> words = { type, id };
		words.insert(words.end(), arguments.begin(), arguments.end());
		to.push_back({ OpFunctionCall, std::move(words) });
		return;
	}
	const uint32_t value = add(to, OpFunctionCall, { uint_ }, arguments);
	to.push_back({ OpBitcast, { type, id, value } });
}

void Rewrite::replaceReads()
{
	std::vector<Instruction> out;
	bool in_function = false;
	for (const Instruction& one : module_.code)
	{
		in_function = in_function || one.op == OpFunction;
		const auto builtin = one.op == OpLoad && in_function ? builtin_of_.find(one.words[2]) : builtin_of_.end();
		const bool loads =
			builtin != builtin_of_.end() && std::find(std::begin(kRewritten), std::end(kRewritten), builtin->second) != std::end(kRewritten);
		if (loads)
			answer(out, wantedOf(builtin->second), one, nullptr);
		else if (const auto wanted = wantedOf(one.op))
		{
			const std::vector<uint32_t> query(one.words.begin() + 2, one.words.end());
			answer(out, *wanted, one, &query);
		}
		else
		{
			if (in_function && one.op != OpLoad && by_builtin_.contains(BuiltInClusterId) &&
				std::find(one.words.begin(), one.words.end(), by_builtin_[BuiltInClusterId].id) != one.words.end() && one.op == OpFunctionCall)
				result_.problems.push_back("gl_ClusterIDNV is passed to a function by reference");
			out.push_back(one);
		}
	}
	module_.code = std::move(out);
}

// Whether an instruction declares a type, a constant or a global variable: where the section of annotations ends.
bool isDeclaration(Op op)
{
	return (op >= OpTypeVoid && op <= OpTypeForwardPointer) || (op >= 41 && op <= 52) || op == OpVariable || op == OpFunction;
}

// Capabilities, the interface of entry points, and the places where the new declarations go.
void Rewrite::fixDeclarations()
{
	const uint32_t cluster_variable = by_builtin_.contains(BuiltInClusterId) ? by_builtin_[BuiltInClusterId].id : 0;
	const bool has_addresses = std::any_of(module_.code.begin(), module_.code.end(), [](const Instruction& one) {
		return one.op == OpCapability && one.words[0] == CapabilityPhysicalAddresses;
	});
	std::vector<Instruction> out;
	if (!has_addresses)
		out.push_back({ OpCapability, { CapabilityPhysicalAddresses } });
	bool declared = false, functions = false;
	for (Instruction& one : module_.code)
	{
		if (one.op == OpCapability && one.words[0] == CapabilityCluster)
			continue;
		if (one.op == OpExtension && one.words == stringWords("SPV_NV_cluster_acceleration_structure"))
			continue;
		if ((one.op == OpName || one.op == OpDecorate) && cluster_variable && one.words[0] == cluster_variable)
			continue;
		if (one.op == OpVariable && cluster_variable && one.words[1] == cluster_variable)
			continue;
		if (one.op == OpMemoryModel)
		{
			if (!has_addresses && module_.version < 0x10500)
				out.push_back({ OpExtension, stringWords("SPV_KHR_physical_storage_buffer") });
			one.words[0] = AddressingPhysical64;
		}
		if (one.op == OpEntryPoint)
		{
			const size_t interface = 2 + stringLength(std::span(one.words).subspan(2));
			one.words.erase(std::remove(one.words.begin() + std::ptrdiff_t(interface), one.words.end(), cluster_variable), one.words.end());
			if (one.words[0] >= ModelIntersection && one.words[0] <= ModelClosestHit)
				one.words.insert(one.words.end(), new_inputs_.begin(), new_inputs_.end());
		}
		if (!declared && isDeclaration(one.op))
		{
			out.insert(out.end(), decorations_.begin(), decorations_.end());
			declared = true;
		}
		if (!functions && one.op == OpFunction)
		{
			out.insert(out.end(), types_.begin(), types_.end());
			functions = true;
		}
		out.push_back(std::move(one));
	}
	out.insert(out.end(), bodies_.begin(), bodies_.end());
	module_.code = std::move(out);
}

Rewritten Rewrite::run()
{
	scan();
	if (!reads())
		return result_;
	declareTables();
	declareInputs();
	for (size_t i = 0; i < size_t(Wanted::Count); ++i)
		defineFunction(static_cast<Wanted>(i));
	replaceReads();
	fixDeclarations();
	result_.words = module_.words();
	return result_;
}

}  // namespace

Rewritten rewriteShader(std::span<const uint32_t> words, VkDeviceAddress root)
{
	std::optional<Module> module = parse(words);
	return module ? Rewrite(*module, root).run() : Rewritten{};
}

}  // namespace tessera::layer
