// Where the time goes: medians over a second, and the last while as a plot.
#include "viewer/panels/panels.h"

#include <algorithm>

namespace tessera::view
{

namespace
{

void plot(Ui& ui, const char* name, const History& history, const std::string& tooltip)
{
	const std::vector<float> values = history.values();
	const float most = values.empty() ? 1 : *std::max_element(values.begin(), values.end());
	ImGui::PlotLines(fmt::format("##{}", name).c_str(), values.data(), static_cast<int>(values.size()), 0,
					 fmt::format("{} {:.2f} ms, most {:.2f}", name, history.median(), most).c_str(), 0, most * 1.1f,
					 ImVec2(-1, ImGui::GetTextLineHeight() * 4));
	ui.note(fmt::format("timing.{}", name), tooltip);
}

void draw(Ui& ui, Session& session)
{
	plot(ui, "frame", session.frame_ms, "from one picture of the scene to the next");
	plot(ui, "device", session.device_ms, "all passes of a frame on the device");
	if (!ImGui::BeginTable("passes", 2, ImGuiTableFlags_RowBg))
		return;
	ImGui::TableSetupColumn("pass");
	ImGui::TableSetupColumn("ms, median of a second");
	ImGui::TableHeadersRow();
	for (const PassTime& pass : session.shown.result.passes)
		valueRow(pass.name.c_str(), fmt::format("{:.3f}", session.pass_ms[pass.name].median()));
	ImGui::EndTable();
}

}  // namespace

const Panel kTimingsPanel = { "Timings", "device time per pass", draw, {} };

}  // namespace tessera::view
