// What the frame runs, and what was left out and why.
#include "viewer/panels/panels.h"

#include <algorithm>

namespace tessera::view
{

namespace
{

void reasonRow(const std::string& name, const std::string& reason)
{
	ImGui::TextUnformatted(name.c_str());
	ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
	ImGui::TextWrapped("%s", reason.c_str());
	ImGui::PopStyleColor();
}

// What --force alone keeps.
void drawForced(const FramePlan& plan)
{
	if (plan.forced.empty() && std::ranges::none_of(plan.features, &Feature::forced) &&
		std::ranges::none_of(plan.resources, &PlannedResource::forced))
		return;
	ImGui::Separator();
	ImGui::TextUnformatted("forced; else left out");
	ImGui::Indent();
	for (const DroppedPass& pass : plan.forced)
		reasonRow(std::string(pass.name), pass.reason);
	for (const Feature& feature : plan.features)
		if (feature.forced)
			reasonRow(std::string(feature.name), std::string(feature.reason));
	for (const PlannedResource& resource : plan.resources)
		if (resource.forced)
			reasonRow(fmt::format("{}, {}", resource.name, bytesText(resource.bytes)), resource.reason);
	ImGui::Unindent();
}

void draw(Ui&, Session& session)
{
	const FramePlan& plan = session.shown.plan;
	ImGui::TextUnformatted("runs");
	ImGui::Indent();
	for (const PlanStep& step : plan.steps)
		ImGui::Text("%s%s", std::string(step.pass->name).c_str(), step.wait_for.empty() ? "" : "  (barrier before)");
	ImGui::Unindent();
	drawForced(plan);
	ImGui::Separator();
	ImGui::TextUnformatted("passes left out");
	ImGui::Indent();
	for (const DroppedPass& dropped : plan.dropped)
		reasonRow(std::string(dropped.name), dropped.reason);
	ImGui::Unindent();
	ImGui::Separator();
	ImGui::TextUnformatted("compiled out of the shaders");
	ImGui::Indent();
	for (const Feature& feature : plan.features)
		if (!feature.on)
			reasonRow(std::string(feature.name), std::string(feature.reason));
	ImGui::Unindent();
	ImGui::Separator();
	ImGui::TextUnformatted("resources left out");
	ImGui::Indent();
	for (const PlannedResource& resource : plan.resources)
		if (!resource.kept)
			reasonRow(fmt::format("{}, {}", resource.name, bytesText(resource.bytes)), resource.reason);
	ImGui::Unindent();
}

}  // namespace

const Panel kPlanPanel = { "Plan", "what the frame runs, what was left out and why", draw, {} };

}  // namespace tessera::view
