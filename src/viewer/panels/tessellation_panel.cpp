// How finely the surface is cut.
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

constexpr std::string_view kOptions[] = { "rate", "metric", "max-split", "pn", "displacement-scale", "displacement-offset", "table" };

void draw(Ui& ui, Session& session)
{
	AppOptions& options = session.options;
	bool tessellates = options.rate > 0;
	if (ui.checkbox("tessellate", "tessellate", tessellates, "off: the mesh as it is stored, rate 0"))
		options.rate = tessellates ? AppOptions().rate : 0;
	if (tessellates)
		ui.slider("rate", "rate, px", options.rate, 0.25f, 64, optionTooltip(*findOption("rate")) + "\nkeys + and - halve and double it by quarters");
	ui.option("metric", options);
	ui.option("max-split", options);
	ui.option("pn", options);
	ui.slider("displacement-scale", "displacement-scale", options.displacement_scale, -4, 4, optionTooltip(*findOption("displacement-scale")));
	const auto reach = session.scene ? static_cast<float>(boundingRadius(session.scene->subject.scene)) / 4 : 1.0f;
	ui.slider("displacement-offset", "displacement-offset", options.displacement_offset, -reach, reach,
			  optionTooltip(*findOption("displacement-offset")));
	ui.option("table", options);
	const FrameResult& result = session.shown.result;
	if (!ImGui::BeginTable("counts", 2))
		return;
	valueRow("rate granted", result.every_factor_one ? "every factor is 1" : fmt::format("{:.4g} px", result.rate_granted));
	valueRow("micro-triangles", fmt::format("{}", result.counts.micro_triangles));
	valueRow("part triangles", fmt::format("{}", result.counts.part_triangles));
	valueRow("split triangles", fmt::format("{}", result.counts.split_triangles));
	valueRow("full clusters", fmt::format("{}", result.counts.full_clusters));
	ImGui::EndTable();
}

}  // namespace

const Panel kTessellationPanel = { "Tessellation", "how finely the surface is cut", draw, kOptions };

}  // namespace tessera::view
