#include "plan_checks.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessera::test
{

namespace
{

bool holds(const Use& use, const PlanInput& input)
{
	return !use.when || use.when->holds(input);
}

// A barrier after step `from` and no later than before step `to` that orders the first access before the second.
bool ordered(const FramePlan& plan, size_t from, Access first, size_t to, Access second)
{
	for (size_t i = from + 1; i <= to; ++i)
		if (plan.steps[i].wait_for.has(first) && plan.steps[i].then.has(second))
			return true;
	return false;
}

}  // namespace

FramePlan planOf(const PlanInput& input)
{
	Result<FramePlan> plan = planFrame(framePasses(), resourceDescs(), kWanted, input);
	EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
	return plan ? std::move(*plan) : FramePlan();
}

bool featureOn(const FramePlan& plan, std::string_view name)
{
	const auto found = std::find_if(plan.features.begin(), plan.features.end(), [&](const Feature& feature) { return feature.name == name; });
	EXPECT_NE(found, plan.features.end()) << name;
	return found != plan.features.end() && found->on;
}

const PlannedResource& resourceOf(const FramePlan& plan, std::string_view name)
{
	static const PlannedResource kNone;
	const auto found = std::find_if(plan.resources.begin(), plan.resources.end(), [&](const PlannedResource& r) { return r.name == name; });
	EXPECT_NE(found, plan.resources.end()) << name;
	return found == plan.resources.end() ? kNone : *found;
}

void expectLeftOut(const FramePlan& plan, std::initializer_list<std::string_view> resources)
{
	for (std::string_view name : resources)
	{
		EXPECT_FALSE(plan.keeps(name)) << name;
		EXPECT_FALSE(resourceOf(plan, name).reason.empty()) << name;
	}
}

void expectKept(const FramePlan& plan, std::initializer_list<std::string_view> resources)
{
	for (std::string_view name : resources)
		EXPECT_TRUE(plan.keeps(name)) << name << ": " << resourceOf(plan, name).reason;
}

void expectDropped(const FramePlan& plan, std::initializer_list<std::string_view> passes)
{
	for (std::string_view name : passes)
	{
		EXPECT_FALSE(plan.has(name)) << name;
		EXPECT_FALSE(plan.reason(name).empty()) << name;
	}
}

bool everyConflictIsOrdered(const FramePlan& plan, const PlanInput& input)
{
	for (size_t later = 0; later < plan.steps.size(); ++later)
		for (const Use& use : plan.steps[later].pass->uses)
		{
			bool met_writer = !holds(use, input);
			for (size_t earlier = later; earlier-- > 0 && !met_writer;)
				for (const Use& before : plan.steps[earlier].pass->uses)
				{
					if (before.resource != use.resource || !holds(before, input) || (!writes(before.access) && !writes(use.access)))
						continue;
					if (!ordered(plan, earlier, before.access, later, use.access))
						return false;
					met_writer |= writes(before.access);
				}
		}
	return true;
}

std::string readBeforeWritten(const FramePlan& plan, const PlanInput& input)
{
	std::vector<std::string_view> written;
	for (const PlanStep& step : plan.steps)
	{
		for (const Use& use : step.pass->uses)
		{
			const std::string_view kind = resourceOf(plan, use.resource).kind;
			const bool made_by_passes = kind == "list" || kind == "image";
			if (made_by_passes && holds(use, input) && !writes(use.access) &&
				std::find(written.begin(), written.end(), use.resource) == written.end())
				return fmt::format("{} reads {}", step.pass->name, use.resource);
		}
		for (const Use& use : step.pass->uses)
			if (holds(use, input) && writes(use.access))
				written.push_back(use.resource);
	}
	return "";
}

void forEveryInput(const std::function<void(const PlanInput&)>& visit)
{
	for (uint32_t bits = 0; bits < 1u << 13; ++bits)
	{
		const auto bit = [&](uint32_t i) {
			return (bits >> i & 1u) != 0;
		};
		PlanInput input = fullInput();
		input.device.mesh_shader = bit(0);
		input.device.fragment_primitive_id = bit(1);
		input.options.raster = bit(2) ? Raster::Indexed : bit(3) ? Raster::Mesh : Raster::Auto;
		input.scene.has_displacement = bit(4);
		input.scene.seam_edges = input.scene.seam_corners = bit(5) ? 3 : 0;
		input.options.rate = bit(6) ? 4.0f : 0.0f;
		input.view.factors_above_one = bit(7);
		input.view.split_levels = bit(8) ? 2 : 0;
		input.options.cull = { bit(9), bit(9), bit(9) };
		input.scene.has_color_textures = bit(10);
		input.options.smooth_normals = bit(11);
		input.scene.directions_are_normals = bit(12);
		input.scene.has_pn = bit(12) != bit(4);
		input.scene.has_vertex_colors = bit(3);
		input.options.view = bit(2) ? ViewMode::Shaded : ViewMode::Depth;
		visit(input);
	}
}

}  // namespace tessera::test
