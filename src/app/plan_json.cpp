#include "app/plan_json.h"

#include "app/option_text.h"

#include <algorithm>
#include <vector>

namespace tessera
{

using nlohmann::ordered_json;

namespace
{

// A kept pass with all its repetitions.
struct KeptPass
{
	std::string name;
	uint32_t repeats = 0;
	uint32_t barriers = 0;
	std::string forced;  // why it would be left out; empty: it is needed
};

std::string forcedText(std::string_view reason)
{
	return fmt::format("forced; else left out: {}", reason);
}

std::string_view forcedBecause(const FramePlan& plan, std::string_view pass)
{
	const auto found = std::find_if(plan.forced.begin(), plan.forced.end(), [&](const DroppedPass& forced) { return forced.name == pass; });
	return found == plan.forced.end() ? std::string_view() : found->reason;
}

std::vector<KeptPass> keptPasses(const FramePlan& plan)
{
	std::vector<KeptPass> passes;
	for (const PlanStep& step : plan.steps)
	{
		if (passes.empty() || passes.back().name != step.pass->name)
			passes.push_back({ std::string(step.pass->name), 0, 0, std::string(forcedBecause(plan, step.pass->name)) });
		++passes.back().repeats;
		passes.back().barriers += step.wait_for.empty() ? 0 : 1;
	}
	return passes;
}

std::string bytesText(uint64_t bytes)
{
	if (bytes < 10'000)
		return fmt::format("{} B", bytes);
	return bytes < 10'000'000 ? fmt::format("{:.0f} KiB", double(bytes) / 1024) : fmt::format("{:.1f} MiB", double(bytes) / (1 << 20));
}

std::string forcedFeaturesText(const FramePlan& plan)
{
	std::string text;
	for (const Feature& feature : plan.features)
		if (feature.forced)
			text += fmt::format("  {:<22} {}\n", feature.name, forcedText(feature.reason));
	return text.empty() ? text : "shader features that are forced\n" + text;
}

std::string keptText(const FramePlan& plan)
{
	std::string text = "passes, in order\n";
	for (const KeptPass& pass : keptPasses(plan))
		text += fmt::format("  {:<22} {}{} before{}\n", pass.name, pass.repeats > 1 ? fmt::format("{} times, ", pass.repeats) : "",
							counted(pass.barriers, "barrier"), pass.forced.empty() ? "" : "; " + forcedText(pass.forced));
	return text + forcedFeaturesText(plan);
}

std::string leftOutText(const FramePlan& plan)
{
	std::string text = "passes left out\n";
	for (const DroppedPass& pass : plan.dropped)
		text += fmt::format("  {:<22} {}\n", pass.name, pass.reason);
	text += "shader features compiled out\n";
	for (const Feature& feature : plan.features)
		if (!feature.on)
			text += fmt::format("  {:<22} {}\n", feature.name, feature.reason);
	return text;
}

std::string resourcesText(const FramePlan& plan, bool kept)
{
	std::string text;
	for (const PlannedResource& resource : plan.resources)
		if (resource.kept == kept)
			text += fmt::format("  {:<22} {:<10} {:>11}  {}\n", resource.name, resource.kind, bytesText(resource.bytes),
								resource.forced ? forcedText(resource.reason) : resource.reason);
	return text;
}

}  // namespace

ordered_json planJson(const ScenePlan& planned)
{
	const FramePlan& plan = planned.plan;
	ordered_json json;
	json["passes"] = ordered_json::array();
	for (const KeptPass& pass : keptPasses(plan))
		json["passes"].push_back(
			{ { "name", pass.name }, { "repeats", pass.repeats }, { "barriers", pass.barriers }, { "forced", !pass.forced.empty() } });
	json["dropped"] = ordered_json::object();
	for (const DroppedPass& pass : plan.dropped)
		json["dropped"][std::string(pass.name)] = pass.reason;
	json["features"] = ordered_json::object();
	for (const Feature& feature : plan.features)
		json["features"][std::string(feature.name)] = { { "on", feature.on }, { "reason", feature.reason }, { "forced", feature.forced } };
	json["resources"] = ordered_json::object();
	for (const PlannedResource& resource : plan.resources)
		json["resources"][std::string(resource.name)] = { { "kind", resource.kind },
														  { "kept", resource.kept },
														  { "bytes", resource.bytes },
														  { "reason", resource.reason },
														  { "forced", resource.forced } };
	json["barriers"] = planned.barriers();
	json["bytes_kept"] = planned.bytesKept();
	json["bytes_saved"] = planned.bytesSaved();
	json["passes_saved"] = plan.dropped.size();
	return json;
}

std::string planText(const ScenePlan& planned)
{
	const FramePlan& plan = planned.plan;
	std::string text = keptText(plan) + leftOutText(plan);
	text += "resources\n" + resourcesText(plan, true) + "resources left out\n" + resourcesText(plan, false);
	text += fmt::format("in all: {}, {}, {} held; left out: {} passes, {}\n", counted(plan.steps.size(), "step"),
						counted(planned.barriers(), "barrier"), bytesText(planned.bytesKept()), plan.dropped.size(), bytesText(planned.bytesSaved()));
	return text;
}

}  // namespace tessera
