// The rewrite: new functions at the module's end look things up; instructions that read one of the built-ins become calls of them.
#include "layer/spirv_rewrite.h"

#include "layer/spirv_lookup.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace tessera::layer
{

namespace
{

using namespace spirv;

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
	void checkStride(const Instruction& trace_ray);
	bool reads() const;
	void declareInputs();
	uint32_t input(std::vector<Instruction>& to, uint32_t builtin);
	void answer(std::vector<Instruction>& to, Wanted wanted, const Instruction& replaced, const std::vector<uint32_t>* query);
	void replaceReads();
	uint32_t clusterVariable() const;
	bool isDropped(const Instruction& one) const;
	void fixEntryPoint(Instruction& entry) const;
	void assemble();

	Module& module_;
	VkDeviceAddress root_;
	Rewritten result_;
	std::map<uint32_t, uint32_t> pointees_;    // pointer type to what it points to
	std::map<uint32_t, uint32_t> constants_;   // their first word
	std::map<uint32_t, Variable> by_builtin_;  // builtin to its input variable
	std::map<uint32_t, uint32_t> builtin_of_;  // variable to builtin
	std::optional<LookupCode> lookup_;
	std::vector<uint32_t> new_inputs_;
	bool has_queries_ = false;
};

constexpr uint32_t kRewritten[] = { BuiltInCustomIndex, BuiltInGeometryIndex, BuiltInClusterId };
constexpr uint32_t kArguments[] = { BuiltInCustomIndex, BuiltInGeometryIndex, BuiltInPrimitiveId };  // of the functions that look up
constexpr uint32_t kVersion15 = 0x10500;

bool isRewritten(uint32_t builtin)
{
	return std::find(std::begin(kRewritten), std::end(kRewritten), builtin) != std::end(kRewritten);
}

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

// Rays that choose hit groups by geometry: here geometries are clusters.
void Rewrite::checkStride(const Instruction& trace_ray)
{
	const auto found = constants_.find(trace_ray.words[4]);
	if (found == constants_.end() || found->second != 0)
		result_.problems.emplace_back("limit-hit-group-stride",
									  "traceRayEXT has a stride between the hit groups of geometries that is not the constant 0");
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
		else if (one.op == OpConstant)
			constants_[words[1]] = words[2];
		else if (one.op == OpTraceRay)
			checkStride(one);
		else if (wantedOf(one.op))
			has_queries_ = true;
		result_.reads_cluster_id = result_.reads_cluster_id || one.op == OpRayQueryClusterId;
	}
	result_.reads_cluster_id = result_.reads_cluster_id || by_builtin_.contains(BuiltInClusterId);
}

uint32_t Rewrite::clusterVariable() const
{
	const auto found = by_builtin_.find(BuiltInClusterId);
	return found == by_builtin_.end() ? 0 : found->second.id;
}

bool Rewrite::reads() const
{
	return has_queries_ || result_.says_so ||
		   std::any_of(std::begin(kRewritten), std::end(kRewritten), [&](uint32_t builtin) { return by_builtin_.contains(builtin); });
}

// Variables for what the look-ups start from, where the module has none.
void Rewrite::declareInputs()
{
	if (std::none_of(std::begin(kRewritten), std::end(kRewritten), [&](uint32_t builtin) { return by_builtin_.contains(builtin); }))
		return;
	for (const uint32_t builtin : kArguments)
		if (!by_builtin_.contains(builtin))
		{
			const uint32_t number = lookup_->uintType();
			const uint32_t pointer = lookup_->type(OpTypePointer, { StorageInput, number });
			const uint32_t variable = lookup_->add(lookup_->declarations, OpVariable, { pointer }, { StorageInput });
			lookup_->decorations.push_back({ OpDecorate, { variable, DecorationBuiltIn, builtin } });
			by_builtin_[builtin] = { variable, number };
			new_inputs_.push_back(variable);
		}
}

// A built-in's value as an unsigned number.
uint32_t Rewrite::input(std::vector<Instruction>& to, uint32_t builtin)
{
	const Variable variable = by_builtin_.at(builtin);
	const uint32_t number = lookup_->uintType();
	const uint32_t value = lookup_->add(to, OpLoad, { variable.type }, { variable.id });
	return variable.type == number ? value : lookup_->add(to, OpBitcast, { number }, { value });
}

// In place of an instruction that read it: the same result id, of the same type. `query`: the ray query and which intersection is meant, if any.
void Rewrite::answer(std::vector<Instruction>& to, Wanted wanted, const Instruction& replaced, const std::vector<uint32_t>* query)
{
	const uint32_t type = replaced.words[0], id = replaced.words[1], number = lookup_->uintType();
	std::vector<uint32_t> arguments = { lookup_->function(wanted) };
	if (query)
		for (const Op op : { OpRayQueryCustomIndex, OpRayQueryGeometryIndex, OpRayQueryPrimitiveIndex })
			arguments.push_back(lookup_->add(to, op, { number }, *query));
	else
		for (const uint32_t builtin : kArguments)
			arguments.push_back(input(to, builtin));
	if (type == number)
	{
		arguments.insert(arguments.begin(), { type, id });
		to.push_back({ OpFunctionCall, std::move(arguments) });
		return;
	}
	const uint32_t value = lookup_->add(to, OpFunctionCall, { number }, arguments);
	to.push_back({ OpBitcast, { type, id, value } });
}

void Rewrite::replaceReads()
{
	std::vector<Instruction> out;
	for (const Instruction& one : module_.code)
	{
		const auto builtin = one.op == OpLoad ? builtin_of_.find(one.words[2]) : builtin_of_.end();
		if (builtin != builtin_of_.end() && isRewritten(builtin->second))
			answer(out, wantedOf(builtin->second), one, nullptr);
		else if (const auto wanted = wantedOf(one.op))
		{
			const std::vector<uint32_t> query(one.words.begin() + 2, one.words.end());
			answer(out, *wanted, one, &query);
		}
		else
		{
			if (one.op == OpFunctionCall || one.op == OpCopyMemory)
				for (const uint32_t word : one.words)
					if (builtin_of_.contains(word) && isRewritten(builtin_of_[word]))
						result_.problems.emplace_back("limit-shader", "a built-in of a hit is read other than by a load");
			out.push_back(one);
		}
	}
	module_.code = std::move(out);
}

// Whether an instruction declares a type, a constant or a global variable: where the section of annotations ends.
bool isDeclaration(Op op)
{
	return (op >= OpTypeVoid && op <= OpTypeForwardPointer) || (op >= OpConstantTrue && op <= OpSpecConstantOp) || op == OpVariable ||
		   op == OpFunction;
}

// Not needed any more, or not known to the driver.
bool Rewrite::isDropped(const Instruction& one) const
{
	if (one.op == OpCapability)
		return one.words[0] == CapabilityCluster;
	if (one.op == OpExtension)
		return one.words == stringWords("SPV_NV_cluster_acceleration_structure");
	const uint32_t variable = clusterVariable();
	if (one.op == OpName || one.op == OpDecorate)
		return variable && one.words[0] == variable;
	return one.op == OpVariable && one.words[1] == variable;
}

void Rewrite::fixEntryPoint(Instruction& entry) const
{
	const size_t interface = 2 + stringLength(std::span(entry.words).subspan(2));
	if (const uint32_t variable = clusterVariable())
		entry.words.erase(std::remove(entry.words.begin() + std::ptrdiff_t(interface), entry.words.end(), variable), entry.words.end());
	if (entry.words[0] >= ModelIntersection && entry.words[0] <= ModelClosestHit)
		entry.words.insert(entry.words.end(), new_inputs_.begin(), new_inputs_.end());
}

// Capabilities, the interfaces of entry points, and the new declarations in their places.
void Rewrite::assemble()
{
	std::vector<Instruction> out;
	const auto append = [&](const std::vector<Instruction>& what) {
		out.insert(out.end(), what.begin(), what.end());
	};
	const bool has_addresses = std::any_of(module_.code.begin(), module_.code.end(), [](const Instruction& one) {
		return one.op == OpCapability && one.words[0] == CapabilityPhysicalAddresses;
	});
	if (!has_addresses)
		out.push_back({ OpCapability, { CapabilityPhysicalAddresses } });
	bool declared = false, functions = false;
	for (Instruction& one : module_.code)
	{
		if (isDropped(one))
			continue;
		if (one.op == OpMemoryModel)
		{
			if (!has_addresses && module_.version < kVersion15)
				out.push_back({ OpExtension, stringWords("SPV_KHR_physical_storage_buffer") });
			one.words[0] = AddressingPhysical64;
		}
		if (one.op == OpEntryPoint)
			fixEntryPoint(one);
		if (!std::exchange(declared, declared || isDeclaration(one.op)) && declared)
			append(lookup_->decorations);
		if (!std::exchange(functions, functions || one.op == OpFunction) && functions)
			append(lookup_->declarations);
		out.push_back(std::move(one));
	}
	append(lookup_->bodies);
	module_.code = std::move(out);
}

Rewritten Rewrite::run()
{
	scan();
	if (!reads())
		return result_;
	lookup_.emplace(module_, root_);
	declareInputs();
	replaceReads();
	assemble();
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
