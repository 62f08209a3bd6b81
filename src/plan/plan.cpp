#include "plan/plan.h"

#include <algorithm>
#include <map>
#include <set>

namespace tessera
{

bool writes(Access access)
{
	return access == Access::ComputeWrite || access == Access::BuildWrite || access == Access::RayWrite || access == Access::Color ||
		   access == Access::Depth || access == Access::CopyWrite;
}

namespace
{

bool holds(const Use& use, const PlanInput& input)
{
	return !use.when || use.when->holds(input);
}

// The first condition of a pass that does not hold; nullptr: all do.
const Condition* broken(const PassDesc& pass, const PlanInput& input)
{
	for (const Condition* condition : pass.needed)
		if (!condition->holds(input))
			return condition;
	return nullptr;
}

bool writesOneOf(const PassDesc& pass, const std::set<std::string_view>& live, const PlanInput& input)
{
	return std::any_of(pass.uses.begin(), pass.uses.end(),
					   [&](const Use& use) { return writes(use.access) && holds(use, input) && live.count(use.resource) > 0; });
}

// Chooses the kept passes, last to first, and says why the others go.
std::vector<const PassDesc*> keepPasses(std::span<const PassDesc* const> passes, std::span<const std::string_view> wanted, const PlanInput& input,
										FramePlan& plan)
{
	std::set<std::string_view> live(wanted.begin(), wanted.end());
	std::vector<const PassDesc*> kept;
	for (size_t i = passes.size(); i-- > 0;)
	{
		const PassDesc& pass = *passes[i];
		if (const Condition* condition = broken(pass, input))
		{
			plan.dropped.push_back({ pass.name, std::string(condition->reason_if_not) });
			continue;
		}
		if (!writesOneOf(pass, live, input))
		{
			plan.dropped.push_back({ pass.name, "nothing reads it" });
			continue;
		}
		for (const Use& use : pass.uses)
			if (holds(use, input))
				live.insert(use.resource);
		kept.push_back(&pass);
	}
	std::reverse(kept.begin(), kept.end());
	std::reverse(plan.dropped.begin(), plan.dropped.end());
	return kept;
}

// Who touched a resource, and which later accesses each touch is already ordered before.
struct Touches
{
	std::map<Access, AccessSet> ordered;  // touch -> accesses that a barrier since has ordered after it
};
using TouchMap = std::map<std::string_view, Touches>;

// One memory barrier per step: from every earlier touch that conflicts and is not ordered yet, to the step's accesses.
void addBarrier(PlanStep& step, TouchMap& touches, const PlanInput& input)
{
	for (const Use& use : step.pass->uses)
	{
		if (!holds(use, input))
			continue;
		for (const auto& [access, ordered] : touches[use.resource].ordered)
			if ((writes(access) || writes(use.access)) && !ordered.has(use.access))
			{
				step.wait_for.add(access);
				step.then.add(use.access);
			}
	}
	for (auto& [resource, touch] : touches)
		for (auto& [access, ordered] : touch.ordered)
			if (step.wait_for.has(access))
				ordered.bits |= step.then.bits;
}

// Records the step's own touches. A write supersedes what went before it.
void addTouches(const PlanStep& step, TouchMap& touches, const PlanInput& input)
{
	for (const Use& use : step.pass->uses)
		if (holds(use, input) && writes(use.access))
			touches[use.resource].ordered.clear();
	for (const Use& use : step.pass->uses)
		if (holds(use, input))
			touches[use.resource].ordered[use.access] = {};
}

void planSteps(const std::vector<const PassDesc*>& kept, const PlanInput& input, FramePlan& plan)
{
	TouchMap touches;
	bool depth_cleared = false;
	for (const PassDesc* pass : kept)
	{
		const uint32_t repeats = pass->repeats ? pass->repeats(input) : 1;
		for (uint32_t repeat = 0; repeat < repeats; ++repeat)
		{
			PlanStep step = { pass, repeat, {}, {}, false };
			addBarrier(step, touches, input);
			addTouches(step, touches, input);
			const bool draws = std::any_of(pass->uses.begin(), pass->uses.end(), [](const Use& use) { return use.access == Access::Depth; });
			step.clears_depth = draws && !depth_cleared;
			depth_cleared |= draws;
			plan.steps.push_back(step);
		}
	}
}

// Why a resource is not kept: the condition of a use in a kept pass, else the reason of a dropped pass that uses it.
std::string reasonWithout(std::string_view resource, std::span<const PassDesc* const> passes, const FramePlan& plan, const PlanInput& input)
{
	for (const PassDesc* pass : passes)
		for (const Use& use : pass->uses)
			if (use.resource == resource && use.when && !holds(use, input) && plan.has(pass->name))
				return std::string(use.when->reason_if_not);
	for (const PassDesc* pass : passes)
		for (const Use& use : pass->uses)
			if (use.resource == resource && !plan.has(pass->name))
				return fmt::format("only {} uses it: {}", pass->name, plan.reason(pass->name));
	return "nothing uses it";
}

void planResources(std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources, const PlanInput& input, FramePlan& plan)
{
	std::set<std::string_view> used;
	for (const PlanStep& step : plan.steps)
		for (const Use& use : step.pass->uses)
			if (holds(use, input))
				used.insert(use.resource);
	for (const ResourceDesc& resource : resources)
	{
		const bool kept = used.count(resource.name) > 0;
		plan.resources.push_back(
			{ resource.name, resource.kind, kept, kept ? "" : reasonWithout(resource.name, passes, plan, input), resource.bytes(input), false });
	}
}

bool isWritten(const FramePlan& plan, std::string_view resource, const PlanInput& input)
{
	return std::any_of(plan.steps.begin(), plan.steps.end(), [&](const PlanStep& step) { return writesOneOf(*step.pass, { resource }, input); });
}

// A list, an image or an acceleration structure holds nothing until a pass writes it; scene arrays and tables come from the host.
bool isMade(std::string_view kind)
{
	return kind == "list" || kind == "image" || kind == "structure";
}

bool isMadeByPasses(std::string_view resource, std::span<const ResourceDesc> resources)
{
	return std::any_of(resources.begin(), resources.end(), [&](const ResourceDesc& desc) { return desc.name == resource && isMade(desc.kind); });
}

// Errors: DeviceCannot when a step reads what no step before it makes, with the reasons of the passes that could.
Status checkReads(const FramePlan& plan, std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources, const PlanInput& input)
{
	std::set<std::string_view> made;
	for (const PlanStep& step : plan.steps)
	{
		for (const Use& use : step.pass->uses)
		{
			if (writes(use.access) || !holds(use, input) || !isMadeByPasses(use.resource, resources) || made.count(use.resource) > 0)
				continue;
			std::string reasons;
			for (const PassDesc* pass : passes)
				if (!plan.has(pass->name) && writesOneOf(*pass, { use.resource }, input))
					reasons += fmt::format("; {}: {}", pass->name, plan.reason(pass->name));
			return fail(ExitCode::DeviceCannot, "{} needs '{}', which nothing makes{}", step.pass->name, use.resource, reasons);
		}
		for (const Use& use : step.pass->uses)
			if (writes(use.access) && holds(use, input))
				made.insert(use.resource);
	}
	return {};
}

}  // namespace

bool FramePlan::has(std::string_view pass) const
{
	return std::any_of(steps.begin(), steps.end(), [&](const PlanStep& step) { return step.pass->name == pass; });
}

std::string FramePlan::reason(std::string_view pass) const
{
	for (const DroppedPass& drop : dropped)
		if (drop.name == pass)
			return drop.reason;
	return {};
}

bool FramePlan::keeps(std::string_view resource) const
{
	return std::any_of(resources.begin(), resources.end(), [&](const PlannedResource& r) { return r.kept && r.name == resource; });
}

bool FramePlan::everyReadHasAnEarlierWriteAndABarrier(const PlanInput& input) const
{
	// For every read look back for the last write of the resource, and for a barrier from that write to this read.
	for (size_t reader = 0; reader < steps.size(); ++reader)
		for (const Use& read : steps[reader].pass->uses)
		{
			if (writes(read.access) || !holds(read, input) || !isWritten(*this, read.resource, input))
				continue;
			bool ordered = false, found = false;
			for (size_t i = reader + 1; i-- > 0 && !found;)
			{
				for (const Use& write : steps[i].pass->uses)
					if (i < reader && writes(write.access) && holds(write, input) && write.resource == read.resource)
					{
						found = true;
						for (size_t barrier = i + 1; barrier <= reader; ++barrier)
							ordered |= steps[barrier].wait_for.has(write.access) && steps[barrier].then.has(read.access);
					}
			}
			// What the host fills is there before the first step.
			const bool by_passes = std::any_of(resources.begin(), resources.end(),
											   [&](const PlannedResource& made) { return made.name == read.resource && isMade(made.kind); });
			if (found ? !ordered : by_passes)
				return false;
		}
	return true;
}

namespace
{

Result<FramePlan> planAll(std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources, std::span<const std::string_view> wanted,
						  const PlanInput& input)
{
	FramePlan plan;
	const std::vector<const PassDesc*> kept = keepPasses(passes, wanted, input, plan);
	planSteps(kept, input, plan);
	for (std::string_view resource : wanted)
	{
		const bool made = std::any_of(kept.begin(), kept.end(), [&](const PassDesc* pass) { return writesOneOf(*pass, { resource }, input); });
		if (!made)
			return fail(ExitCode::DeviceCannot, "nothing can write '{}' on this device with these options", resource);
	}
	TRY(checkReads(plan, passes, resources, input));
	planResources(passes, resources, input, plan);
	plan.features = shaderFeatures(input);
	return plan;
}

// Marks what the plan has beyond the one in which nothing is forced. Both list resources and features in the same order.
void markForced(FramePlan& plan, const FramePlan& unforced)
{
	for (const DroppedPass& drop : unforced.dropped)
		if (plan.has(drop.name))
			plan.forced.push_back(drop);
	for (size_t i = 0; i < plan.resources.size(); ++i)
		if (plan.resources[i].kept && !unforced.resources[i].kept)
		{
			plan.resources[i].forced = true;
			plan.resources[i].reason = unforced.resources[i].reason;
		}
	for (size_t i = 0; i < plan.features.size(); ++i)
		if (plan.features[i].on && !unforced.features[i].on)
		{
			plan.features[i].forced = true;
			plan.features[i].reason = unforced.features[i].reason;
		}
}

}  // namespace

Result<FramePlan> planFrame(std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources,
							std::span<const std::string_view> wanted, const PlanInput& input)
{
	if (input.forced.empty())
		return planAll(passes, resources, wanted, input);
	std::vector<std::string_view> all(wanted.begin(), wanted.end());
	all.insert(all.end(), input.forced.outputs.begin(), input.forced.outputs.end());
	TRY_ASSIGN(FramePlan plan, planAll(passes, resources, all, input));
	PlanInput unforced = input;
	unforced.forced = {};
	TRY_ASSIGN(const FramePlan base, planAll(passes, resources, wanted, unforced));
	markForced(plan, base);
	return plan;
}

}  // namespace tessera
