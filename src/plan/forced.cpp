#include "plan/forced.h"

#include <algorithm>

namespace tessera
{

namespace
{

class Forcing
{
public:
	Forcing(std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources, std::span<const std::string_view> wanted,
			const PlanInput& input)
		: passes_(passes), resources_(resources), wanted_(wanted), input_(input)
	{
		input_.forced = {};
	}

	// Errors leave everything as it was.
	Status add(std::string_view name)
	{
		const Forced before = forced();
		const Status status = addNamed(name);
		if (!status)
			forced() = before;
		return status;
	}

	Forced& forced() { return input_.forced; }

private:
	Status addNamed(std::string_view name)
	{
		TRY_ASSIGN(plan_, planFrame(passes_, resources_, wanted_, input_));
		const auto pass = std::find_if(passes_.begin(), passes_.end(), [&](const PassDesc* desc) { return desc->name == name; });
		if (pass != passes_.end())
			return addPass(**pass);
		const auto feature = std::find_if(plan_.features.begin(), plan_.features.end(), [&](const Feature& f) { return f.name == name; });
		if (feature != plan_.features.end())
			return addCondition(*feature->condition);
		const bool is_resource = std::any_of(resources_.begin(), resources_.end(), [&](const ResourceDesc& desc) { return desc.name == name; });
		if (is_resource)
			return addResource(name);
		return fail(ExitCode::Usage, "no such pass, shader feature or resource; there are {}", fmt::join(forceNames(passes_, resources_), ", "));
	}

	// Also where it holds already: with another view it might not.
	Status addCondition(const Condition& condition)
	{
		if (condition.isForceable(input_) && !input_.forces(condition))
			forced().conditions.push_back(&condition);
		if (!condition.holds(input_))
			return fail(ExitCode::Usage, "it is left out ({}) and cannot be forced: {}", condition.reason_if_not, condition.why_not_forced);
		return {};
	}

	Status addPass(const PassDesc& pass)
	{
		for (const Condition* condition : pass.needed)
			TRY(addCondition(*condition));
		TRY_ASSIGN(plan_, planFrame(passes_, resources_, wanted_, input_));
		if (plan_.has(pass.name))
			return {};
		// Nothing reads what it writes: that is wanted for its own sake.
		for (const Use& use : pass.uses)
			if (writes(use.access) && (!use.when || use.when->holds(input_)))
				forced().outputs.push_back(use.resource);
		return {};
	}

	// By what keeps a kept pass from using it, else by a pass that does.
	Status addResource(std::string_view name)
	{
		if (plan_.keeps(name))
			return {};
		const FramePlan before = plan_;
		Status refused;
		for (const bool of_kept : { true, false })
			for (const PassDesc* pass : passes_)
				for (const Use& use : pass->uses)
				{
					if (use.resource != name || before.has(pass->name) != of_kept || (of_kept && !use.when))
						continue;
					const Status status = addUser(name, *pass, use, of_kept);
					if (status)
						return status;
					if (refused)
						refused = status;
				}
		return refused ? fail(ExitCode::Usage, "it is left out (nothing uses it) and cannot be forced: nothing would") : refused;
	}

	// Errors leave everything as it was.
	Status addUser(std::string_view resource, const PassDesc& pass, const Use& use, bool is_kept)
	{
		const Forced before = forced();
		Status status = is_kept ? addCondition(*use.when) : addPass(pass);
		if (status)
		{
			TRY_ASSIGN(plan_, planFrame(passes_, resources_, wanted_, input_));
			if (plan_.keeps(resource))
				return {};
			// The pass runs now, but uses it under a condition of its own.
			status = use.when ? addCondition(*use.when) : fail(ExitCode::Usage, "cannot be forced: {} does without it", pass.name);
		}
		if (!status)
			forced() = before;
		return status;
	}

	std::span<const PassDesc* const> passes_;
	std::span<const ResourceDesc> resources_;
	std::span<const std::string_view> wanted_;
	PlanInput input_;
	FramePlan plan_;
};

}  // namespace

std::vector<std::string_view> forceNames(std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources)
{
	std::vector<std::string_view> names;
	for (const PassDesc* pass : passes)
		names.push_back(pass->name);
	for (const Feature& feature : shaderFeatures({}))
		names.push_back(feature.name);
	for (const ResourceDesc& resource : resources)
		names.push_back(resource.name);
	return names;
}

Result<Forced> forcedBy(std::span<const std::string> names, std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources,
						std::span<const std::string_view> wanted, const PlanInput& input)
{
	Forcing forcing(passes, resources, wanted, input);
	std::vector<std::string> left(names.begin(), names.end());
	while (!left.empty())
	{
		std::vector<std::string> refused;
		Status first;
		for (const std::string& name : left)
			if (const Status status = forcing.add(name); !status)
			{
				if (first)
					first = fail(status.error().code, "--force {}: {}", name, status.error().message);
				refused.push_back(name);
			}
		// One may need another that came behind it.
		if (refused.size() == left.size())
			return tl::unexpected(first.error());
		left = std::move(refused);
	}
	return forcing.forced();
}

}  // namespace tessera
