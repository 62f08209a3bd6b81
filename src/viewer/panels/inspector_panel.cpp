// What the picked pixel sees.
#include "viewer/panels/panels.h"

#include <algorithm>

namespace tessera::view
{

namespace
{

std::string text(const DomainPoint& point)
{
	return fmt::format("{:.6f} {:.6f}", double(point.u) / DOMAIN_SIZE, double(point.v) / DOMAIN_SIZE);
}

void drawFacts(const Inspection& found)
{
	if (!ImGui::BeginTable("facts", 2))
		return;
	valueRow("pixel", fmt::format("{}, {}", found.pixel.x, found.pixel.y));
	valueRow("instance, mesh", fmt::format("{}, {}", found.cluster.instance, found.mesh));
	valueRow("material", fmt::format("{} {}", found.material, found.material_name));
	valueRow("cluster", fmt::format("{}", found.cluster.cluster));
	valueRow("triangle of cluster", fmt::format("{}", found.triangle));
	valueRow("triangle of mesh", fmt::format("{}", found.source_triangle));
	valueRow("drawn as", found.is_part ? "part triangle" : "full cluster");
	valueRow("factors", fmt::format("{} {} {}{}", found.factors[0], found.factors[1], found.factors[2], found.mirrored ? ", mirrored" : ""));
	valueRow("config, micro-triangle", fmt::format("{}, {}", found.config, found.micro));
	valueRow("depth", fmt::format("{:.6g}", found.depth_world));
	if (found.is_part)
	{
		valueRow("batch", fmt::format("{}: {} parts", found.batch, found.batch_parts));
		valueRow("its vertices", fmt::format("{} of {}", found.batch_vertices, found.most_batch_vertices));
		valueRow("its triangles", fmt::format("{} of {}", found.batch_triangles, found.most_batch_triangles));
	}
	ImGui::EndTable();
}

void drawVertices(const Inspection& found)
{
	for (size_t i = 0; i < found.vertices.size(); ++i)
	{
		const InspectedVertex& vertex = found.vertices[i];
		ImGui::TextWrapped("vertex %zu: domain %s\n  position %.6g %.6g %.6g, moved by %.4g", i, text(vertex.domain).c_str(), vertex.position_world.x,
						   vertex.position_world.y, vertex.position_world.z, double(vertex.displacement));
	}
	const vec3& normal = found.vertices[0].normal_world;
	ImGui::Text("facet normal %.4f %.4f %.4f", double(normal.x), double(normal.y), double(normal.z));
}

void drawSplits(const Inspection& found)
{
	ImGui::Text("split path: %zu", found.splits.size());
	for (const SplitStep& step : found.splits)
		ImGui::TextWrapped("  (%s) (%s) (%s) in %u %u %u pieces", text(step.corners[0]).c_str(), text(step.corners[1]).c_str(),
						   text(step.corners[2]).c_str(), step.pieces[0], step.pieces[1], step.pieces[2]);
}

// The pattern in the triangle's own plane, the picked micro-triangle filled.
void drawPattern(Ui& ui, const Inspection& found)
{
	const float side = std::min(ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 18);
	const ImVec2 low = ImGui::GetCursorScreenPos();
	ImGui::Dummy(ImVec2(side, side * 0.9f));
	ui.note("inspector.pattern", "the part's pattern from the table; the picked micro-triangle is filled");
	const auto place = [&](const vec2& weights) {
		const float third = 1 - weights.x - weights.y;
		return ImVec2(low.x + side * (0.03f + 0.94f * (weights.y + 0.5f * third)), low.y + side * (0.85f - 0.81f * third));
	};
	ImDrawList& drawing = *ImGui::GetWindowDrawList();
	for (size_t t = 0; t < found.pattern_triangles.size(); ++t)
	{
		const uvec3& corners = found.pattern_triangles[t];
		const ImVec2 a = place(found.pattern_points[corners.x]), b = place(found.pattern_points[corners.y]),
					 c = place(found.pattern_points[corners.z]);
		if (t == found.micro)
			drawing.AddTriangleFilled(a, b, c, IM_COL32(220, 120, 40, 200));
		drawing.AddTriangle(a, b, c, IM_COL32(200, 200, 210, 255));
	}
	for (const vec2& point : found.pattern_points)
		drawing.AddCircleFilled(place(point), 2, IM_COL32(120, 190, 255, 255));
}

void draw(Ui& ui, Session& session)
{
	if (!session.inspection)
	{
		ImGui::TextWrapped("Click a pixel of the picture.");
		return;
	}
	const Inspection& found = *session.inspection;
	if (!found.covered)
	{
		ImGui::TextWrapped("pixel %u, %u: %s", found.pixel.x, found.pixel.y, found.why_not.c_str());
		return;
	}
	drawFacts(found);
	drawVertices(found);
	drawSplits(found);
	drawPattern(ui, found);
}

}  // namespace

const Panel kInspectorPanel = { "Inspector", "what the picked pixel sees", draw, {} };

}  // namespace tessera::view
