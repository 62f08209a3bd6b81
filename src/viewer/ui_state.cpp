#include "viewer/ui_state.h"

#include "app/stats_json.h"
#include "viewer/interface.h"

namespace tessera::view
{

using nlohmann::ordered_json;

namespace
{

ordered_json vectorJson(const dvec3& v)
{
	return { v.x, v.y, v.z };
}

ordered_json cameraJson(const Camera& camera)
{
	return { { "eye", vectorJson(camera.eye) }, { "target", vectorJson(camera.target) }, { "up", vectorJson(camera.up) },
			 { "fov_rad", camera.fov_y_rad },   { "near", camera.near_world },           { "orthographic", camera.orthographic } };
}

ordered_json listsJson(const Session& session)
{
	constexpr const char* kFillNames[] = { "roomy", "tight", "full" };
	ordered_json json = ordered_json::object();
	for (const ListStats& list : session.shown.result.lists)
	{
		const uint64_t high_water = session.high_water.of(list.name);
		json[list.name] = { { "wanted", list.wanted },
							{ "capacity", list.capacity },
							{ "high_water", high_water },
							{ "fill", kFillNames[static_cast<size_t>(fillOf(high_water, list.capacity))] } };
	}
	return json;
}

ordered_json frameJson(const Session& session)
{
	const ShownFrame& shown = session.shown;
	ordered_json passes = ordered_json::object();
	for (const PassTime& pass : shown.result.passes)
		passes[pass.name] = pass.gpu_ms;
	return { { "number", shown.number },
			 { "rate_wanted", shown.result.rate_wanted },
			 { "rate_granted", shown.result.rate_granted },
			 { "coarsening", shown.result.coarsening },
			 { "rounds", shown.result.rounds },
			 { "attempts", shown.result.attempts },
			 { "micro_triangles", shown.result.counts.micro_triangles },
			 { "part_triangles", shown.result.counts.part_triangles },
			 { "visible_clusters", shown.result.counts.visible_clusters },
			 { "covered_pixels", shown.result.counts.covered_pixels },
			 { "frame_ms", session.frame_ms.median() },
			 { "device_ms", session.device_ms.median() },
			 { "passes", passes },
			 { "options", optionsJson(shown.options) },
			 { "camera", cameraJson(shown.camera) },
			 { "drawn_from", cameraJson(shown.drawn_from) } };
}

ordered_json inspectionJson(const Session& session)
{
	if (!session.inspection)
		return nullptr;
	const Inspection& found = *session.inspection;
	ordered_json json = { { "pixel", { found.pixel.x, found.pixel.y } }, { "covered", found.covered } };
	if (!found.covered)
	{
		json["why_not"] = found.why_not;
		return json;
	}
	json["instance"] = found.cluster.instance;
	json["cluster"] = found.cluster.cluster;
	json["triangle"] = found.triangle;
	json["material"] = found.material_name;
	json["is_part"] = found.is_part;
	json["factors"] = found.factors;
	json["config"] = found.config;
	json["micro_triangle"] = found.micro;
	json["pattern_triangles"] = found.pattern_triangles.size();
	json["splits"] = found.splits.size();
	json["batch"] = { { "parts", found.batch_parts }, { "vertices", found.batch_vertices }, { "triangles", found.batch_triangles } };
	json["depth"] = found.depth_world;
	for (const InspectedVertex& vertex : found.vertices)
		json["positions"].push_back(vectorJson(vertex.position_world));
	return json;
}

ordered_json widgetsJson(const Ui& ui)
{
	ordered_json json = ordered_json::object();
	for (const auto& [name, place] : ui.places())
		json[name] = { { "low", { place.low.x, place.low.y } }, { "high", { place.high.x, place.high.y } }, { "visible", place.visible } };
	return json;
}

}  // namespace

ordered_json uiState(const Session& session, const Ui& ui, uint64_t written)
{
	ordered_json json = { { "schema", 1 }, { "written", written } };
	json["scene"] = session.scene_name;
	if (session.scene)
		json["base_triangles"] = session.scene->subject.scene.traits.base_triangles;
	json["loading"] = session.loader->isLoading();
	json["error"] = session.error;
	json["warnings"] = viewportWarnings(session);
	json["options"] = optionsJson(session.options);
	json["camera"] = cameraJson(session.camera);
	json["frame"] = frameJson(session);
	json["lists"] = listsJson(session);
	json["frozen"] = session.is_frozen;
	json["debug_camera"] = session.debug_camera;
	json["culled_camera"] = cameraJson(session.culled_camera);
	json["path"] = { { "keys", session.path.keys.size() }, { "plays", session.plays_path }, { "records", session.records_path } };
	json["inspection"] = inspectionJson(session);
	json["shaders"] = { { "compiling", session.shaders.is_compiling },
						{ "reloads", session.shaders.reloads },
						{ "replaced", session.shaders.replaced },
						{ "error", session.shaders.error } };
	json["command_line"] = session.command_line;
	json["viewport"] = { { "low", { session.viewport_low.x, session.viewport_low.y } },
						 { "size", { session.viewport_size.x, session.viewport_size.y } } };
	json["interface"] = session.shows_interface;
	json["vsync"] = session.vsync;
	json["full_screen"] = session.is_full_screen;
	json["asks_for_path"] = session.asks_for_path;
	json["is_typing"] = ImGui::GetIO().WantTextInput;  // a text field has the keyboard
	json["open_panels"] = ordered_json::array();
	for (const auto& [name, open] : session.open_panels)
		if (open)
			json["open_panels"].push_back(name);
	json["validation_messages"] = session.device->validationMessages();
	json["log"] = ordered_json::array();
	for (const LogEntry& entry : session.log)
		json["log"].push_back(entry.text);
	json["widgets"] = widgetsJson(ui);
	return json;
}

}  // namespace tessera::view
