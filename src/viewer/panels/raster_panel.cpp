// Who finds visibility, and what is culled before.
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

constexpr std::string_view kOptions[] = { "raster", "cull" };

void draw(Ui& ui, Session& session)
{
	ui.option("raster", session.options);
	ui.option("cull", session.options);
	const FrameResult& result = session.shown.result;
	if (!ImGui::BeginTable("counts", 2))
		return;
	valueRow("visible clusters", fmt::format("{}", result.counts.visible_clusters));
	valueRow("hidden parts", fmt::format("{}", result.counts.hidden_parts));
	valueRow("revealed parts", fmt::format("{}", result.counts.revealed_parts));
	valueRow("covered pixels", fmt::format("{}", result.counts.covered_pixels));
	valueRow("attempts", fmt::format("{}", result.attempts));
	valueRow("rounds", fmt::format("{}", result.rounds));
	ImGui::EndTable();
}

}  // namespace

const Panel kRasterPanel = { "Raster", "who finds visibility, and what is culled before", draw, kOptions };

}  // namespace tessera::view
