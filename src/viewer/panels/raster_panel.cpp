// Who finds visibility, and what is culled before.
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

constexpr std::string_view kOptions[] = { "raster", "cull" };

void drawCameras(Ui& ui, Session& session)
{
	const bool was_separate = session.separates();
	ui.checkbox("freeze", "freeze", session.is_frozen, "culling and tessellation stay as they are for this camera, however the picture's moves");
	ui.checkbox("debug_camera", "debug camera", session.debug_camera,
				"a second camera that is culled and tessellated for, with its frustum drawn; Shift moves it (Q)");
	if (session.separates() && !was_separate)
		session.culled_camera = session.camera;
	if (session.separates() && ui.button("look_through", "look through it", "move the picture's camera to where it is culled and tessellated for"))
		session.camera = session.culled_camera;
	if (session.separates())
		ImGui::TextDisabled("what is hidden is drawn meanwhile");
}

void drawGizmoSwitches(Ui& ui, Gizmos& gizmos)
{
	ui.checkbox("gizmo.instances", "boxes of instances", gizmos.instances, "displaced bounds of every instance: green kept, red culled");
	ui.checkbox("gizmo.clusters", "boxes of clusters", gizmos.clusters, "displaced bounds of every cluster: green kept, red culled");
	ui.checkbox("gizmo.cones", "normal cones", gizmos.cones, "of clusters that are neither displaced nor double-sided");
	ui.checkbox("gizmo.kept", "of those kept", gizmos.kept, "those that the device listed as visible");
	ImGui::SameLine();
	ui.checkbox("gizmo.culled", "of those culled", gizmos.culled, "those that it did not");
}

void draw(Ui& ui, Session& session)
{
	ui.option("raster", session.options);
	ui.option("cull", session.options);
	drawCameras(ui, session);
	drawGizmoSwitches(ui, session.gizmos);
	const FrameResult& result = session.shown.result;
	if (!ImGui::BeginTable("counts", 2))
		return;
	valueRow("visible clusters", fmt::format("{}", result.counts.visible_clusters));
	valueRow("hidden parts", fmt::format("{}", result.counts.hidden_parts));
	valueRow("revealed parts", fmt::format("{}", result.counts.revealed_parts));
	valueRow("hidden full clusters", fmt::format("{}", result.counts.hidden_clusters));
	valueRow("covered pixels", fmt::format("{}", result.counts.covered_pixels));
	valueRow("attempts", fmt::format("{}", result.attempts));
	valueRow("rounds", fmt::format("{}", result.rounds));
	ImGui::EndTable();
}

}  // namespace

const Panel kRasterPanel = { "Raster", "who finds visibility, and what is culled before", draw, kOptions };

}  // namespace tessera::view
