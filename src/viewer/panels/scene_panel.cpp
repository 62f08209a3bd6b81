// What is drawn: the scene, its materials and displacement, copies of it.
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

constexpr std::string_view kOptions[] = { "grid", "grid-u", "grid-v", "displacement", "cluster-size" };

void drawMaterials(const BuiltScene& scene)
{
	if (!ImGui::BeginTable("materials", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY, ImVec2(0, ImGui::GetTextLineHeight() * 9)))
		return;
	ImGui::TableSetupColumn("material");
	ImGui::TableSetupColumn("height map");
	ImGui::TableSetupColumn("sides");
	ImGui::TableHeadersRow();
	for (const MaterialData& material : scene.materials)
	{
		ImGui::TableNextRow();
		ImGui::TableNextColumn();
		const vec4& color = material.base_color;
		ImGui::ColorButton(material.name.c_str(), ImVec4(color.r, color.g, color.b, 1), ImGuiColorEditFlags_NoTooltip,
						   ImVec2(ImGui::GetFontSize(), ImGui::GetFontSize()));
		ImGui::SameLine();
		ImGui::TextUnformatted(material.name.empty() ? "(no name)" : material.name.c_str());
		ImGui::TableNextColumn();
		const bool has_map = material.height_map < scene.height_maps.size();
		ImGui::TextUnformatted(has_map ? scene.height_maps[material.height_map].name.c_str() : "none");
		ImGui::TableNextColumn();
		ImGui::TextUnformatted(material.double_sided ? "both" : "front");
	}
	ImGui::EndTable();
}

void draw(Ui& ui, Session& session)
{
	if (ui.button("scene.open", "open ...", "another scene: a .gltf or .glb file, or builtin:NAME (Ctrl+O); files can be dropped on the window too"))
		session.asks_for_path = true;
	for (std::string_view option : kOptions)
		ui.option(option, session.options);
	if (!session.scene)
		return;
	const BuiltScene& scene = session.scene->subject.scene;
	if (ImGui::BeginTable("facts", 2))
	{
		valueRow("base triangles", fmt::format("{}", scene.traits.base_triangles));
		valueRow("over all instances", fmt::format("{}", scene.traits.instanced_triangles));
		valueRow("instances, meshes", fmt::format("{}, {}", scene.instances.size(), scene.meshes.size()));
		valueRow("clusters", fmt::format("{}", scene.clusters.size()));
		valueRow("seam edges, corners", fmt::format("{}, {}", scene.traits.seam_edges, scene.traits.seam_corners));
		valueRow("open edges", fmt::format("{}", scene.traits.boundary_edges));
		ImGui::EndTable();
	}
	drawMaterials(scene);
}

}  // namespace

const Panel kScenePanel = { "Scene", "what is drawn: materials, displacement, copies", draw, kOptions };

}  // namespace tessera::view
