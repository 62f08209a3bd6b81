// What the device holds.
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

void draw(Ui&, Session& session)
{
	const MemoryStats& memory = session.shown.memory;
	if (ImGui::BeginTable("kinds", 2))
	{
		valueRow("lists", bytesText(memory.lists));
		valueRow("geometry", bytesText(memory.geometry));
		valueRow("textures", bytesText(memory.textures));
		valueRow("images", bytesText(memory.images));
		valueRow("rays", bytesText(memory.rays));
		valueRow("together", bytesText(memory.total()));
		const RayClusterStats& clusters = session.shown.result.rays.clusters;
		if (clusters.built)
		{
			valueRow("rays: templates", fmt::format("{}, {}", clusters.templates, bytesText(clusters.template_bytes)));
			valueRow("rays: clusters", fmt::format("{} of {}", bytesText(clusters.data_used_bytes), bytesText(clusters.data_bytes)));
			valueRow("rays: structures", fmt::format("{} of {}", bytesText(clusters.structure_used_bytes), bytesText(clusters.structure_bytes)));
			valueRow("rays: from templates", fmt::format("{} full clusters, {} parts", clusters.full, clusters.parts));
			valueRow("rays: transient", fmt::format("{} of 1x1x1, {} of <= 2x2x2", clusters.units, clusters.groups));
		}
		ImGui::EndTable();
	}
	if (!ImGui::BeginTable("resources", 3, ImGuiTableFlags_RowBg))
		return;
	ImGui::TableSetupColumn("resource");
	ImGui::TableSetupColumn("kind");
	ImGui::TableSetupColumn("planned size");
	ImGui::TableHeadersRow();
	for (const PlannedResource& resource : session.shown.plan.resources)
		if (resource.kept)
		{
			valueRow(std::string(resource.name).c_str(), std::string(resource.kind));
			ImGui::TableNextColumn();
			ImGui::TextUnformatted(bytesText(resource.bytes).c_str());
		}
	ImGui::EndTable();
}

}  // namespace

const Panel kMemoryPanel = { "Memory", "what the device holds", draw, {} };

}  // namespace tessera::view
