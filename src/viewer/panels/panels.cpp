#include "viewer/panels/panels.h"

namespace tessera::view
{

std::span<const Panel> panels()
{
	static const Panel kPanels[] = { kCameraPanel, kTessellationPanel, kRasterPanel, kViewPanel,      kScenePanel,   kLimitsPanel, kTimingsPanel,
									 kMemoryPanel, kPlanPanel,         kGatesPanel,  kInspectorPanel, kShadersPanel, kLogPanel };
	return kPanels;
}

std::span<const std::string_view> optionsWithoutPanel()
{
	static constexpr std::string_view kNames[] = { "size",     "frames",         "warmup",       "rates",  "rasters",          "metrics",
												   "sizes",    "reference-rate", "max-error-px", "max-ms", "resume",           "pipelines",
												   "validate", "strict",         "quiet",        "force",  "measure-left-out", "original" };
	return kNames;
}

void valueRow(const char* name, const std::string& value)
{
	ImGui::TableNextRow();
	ImGui::TableNextColumn();
	ImGui::TextUnformatted(name);
	ImGui::TableNextColumn();
	ImGui::TextUnformatted(value.c_str());
}

std::string bytesText(uint64_t bytes)
{
	if (bytes < 10000)
		return fmt::format("{} B", bytes);
	return bytes < 10000000 ? fmt::format("{:.1f} kB", double(bytes) / 1e3) : fmt::format("{:.1f} MB", double(bytes) / 1e6);
}

}  // namespace tessera::view
