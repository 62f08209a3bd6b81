// Every list: what was wanted of it against what it holds.
#include "frame/lists.h"
#include "viewer/panels/panels.h"

#include <algorithm>

namespace tessera::view
{

namespace
{

constexpr std::string_view kOptions[] = { "capacity", "budget" };

ImVec4 colorOf(Fill fill)
{
	switch (fill)
	{
	case Fill::Full:
		return { 0.85f, 0.25f, 0.20f, 1 };
	case Fill::Tight:
		return { 0.85f, 0.65f, 0.15f, 1 };
	default:
		return { 0.25f, 0.55f, 0.35f, 1 };
	}
}

void drawBar(Ui& ui, Session& session, const ListStats& list)
{
	const uint64_t high_water = session.high_water.of(list.name);
	const float filled = list.capacity > 0 ? std::min(1.0f, float(double(list.wanted) / list.capacity)) : 1;
	ImGui::TextUnformatted(list.name.c_str());
	ImGui::PushStyleColor(ImGuiCol_PlotHistogram, colorOf(fillOf(list.wanted, list.capacity)));
	ImGui::ProgressBar(filled, ImVec2(-1, 0), fmt::format("{} / {}", list.wanted, list.capacity).c_str());
	ImGui::PopStyleColor();
	ui.note("limit." + list.name, fmt::format("{} wanted by the last frame, {} held\nthe most that was ever wanted: {}\n{}", list.wanted,
											  list.capacity, high_water, bytesText(list.bytes)));
	// The mark of the most that was ever wanted.
	const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
	const float mark = list.capacity > 0 ? std::min(1.0f, float(double(high_water) / list.capacity)) : 1;
	const float x = low.x + (high.x - low.x) * mark;
	ImGui::GetWindowDrawList()->AddLine(ImVec2(x, low.y), ImVec2(x, high.y), ImGui::GetColorU32(colorOf(fillOf(high_water, list.capacity))), 3);
}

void draw(Ui& ui, Session& session)
{
	ui.option("capacity", session.options);
	ui.option("budget", session.options);
	session.requests.fit_lists |=
		ui.button("limits.fit", "fit", "give every list the most that was ever wanted of it, and an eighth more; at once, without a restart");
	ImGui::SameLine();
	if (ui.button("limits.free", "defaults", "capacities as at the start, without --capacity and --budget"))
	{
		session.options.capacities.clear();
		session.options.lists_bytes = 0;
	}
	ImGui::SameLine();
	if (ui.button("limits.clear", "clear marks", "forget the high-water marks"))
		session.high_water.clear();
	for (const ListStats& list : session.shown.result.lists)
		drawBar(ui, session, list);
}

}  // namespace

const Panel kLimitsPanel = { "Limits", "every list: wanted against capacity", draw, kOptions };

}  // namespace tessera::view
