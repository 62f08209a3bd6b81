#include "viewer/settings.h"

#include "base/file.h"
#include "viewer/panels/panels.h"

#include <algorithm>
#include <cstdlib>

namespace tessera::view
{

using nlohmann::ordered_json;

namespace
{

constexpr uint32_t kLeastSide = 64, kMostSide = 16384;
constexpr uint64_t kMostBytes = 1u << 20;

void takeBool(const ordered_json& json, const char* name, bool& value)
{
	if (const auto found = json.find(name); found != json.end() && found->is_boolean())
		value = found->get<bool>();
}

void takeText(const ordered_json& json, const char* name, std::string& value)
{
	if (const auto found = json.find(name); found != json.end() && found->is_string())
		value = found->get<std::string>();
}

}  // namespace

std::filesystem::path settingsFile()
{
	if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder && *folder)
		return std::filesystem::path(folder) / "tessera/view.json";
	if (const char* folder = std::getenv("APPDATA"); folder && *folder)
		return std::filesystem::path(folder) / "tessera/view.json";
	const char* home = std::getenv("HOME");
	return home && *home ? std::filesystem::path(home) / ".config/tessera/view.json" : std::filesystem::path();
}

ordered_json settingsJson(const Session& session, uvec2 window_px)
{
	ordered_json json = {
		{ "schema", 1 }, { "window", { window_px.x, window_px.y } }, { "vsync", session.vsync }, { "panels", ordered_json::array() }
	};
	for (const auto& [name, open] : session.open_panels)
		if (open)
			json["panels"].push_back(name);
	json["typed_path"] = session.typed_path;
	json["path_file"] = session.path_file;
	const Gizmos& gizmos = session.gizmos;
	json["gizmos"] = { { "instances", gizmos.instances },
					   { "clusters", gizmos.clusters },
					   { "cones", gizmos.cones },
					   { "kept", gizmos.kept },
					   { "culled", gizmos.culled } };
	return json;
}

uvec2 applySettings(const ordered_json& json, Session& session)
{
	if (!json.is_object())
		return { 0, 0 };
	takeBool(json, "vsync", session.vsync);
	takeText(json, "typed_path", session.typed_path);
	takeText(json, "path_file", session.path_file);
	if (const auto open = json.find("panels"); open != json.end() && open->is_array())
	{
		session.open_panels.clear();
		for (const Panel& panel : panels())
			session.open_panels[std::string(panel.name)] = std::find(open->begin(), open->end(), std::string(panel.name)) != open->end();
	}
	if (const auto gizmos = json.find("gizmos"); gizmos != json.end() && gizmos->is_object())
	{
		takeBool(*gizmos, "instances", session.gizmos.instances);
		takeBool(*gizmos, "clusters", session.gizmos.clusters);
		takeBool(*gizmos, "cones", session.gizmos.cones);
		takeBool(*gizmos, "kept", session.gizmos.kept);
		takeBool(*gizmos, "culled", session.gizmos.culled);
	}
	const auto window = json.find("window");
	if (window == json.end() || !window->is_array() || window->size() != 2 || !(*window)[0].is_number_unsigned() ||
		!(*window)[1].is_number_unsigned())
		return { 0, 0 };
	const uvec2 size = { (*window)[0].get<uint32_t>(), (*window)[1].get<uint32_t>() };
	const bool right = glm::min(size.x, size.y) >= kLeastSide && glm::max(size.x, size.y) <= kMostSide;
	return right ? size : uvec2(0);
}

ordered_json readSettings(const std::filesystem::path& file)
{
	const auto bytes = readFile(file, kMostBytes);
	if (!bytes)
		return {};
	const auto* text = reinterpret_cast<const char*>(bytes->data());
	return ordered_json::parse(text, text + bytes->size(), nullptr, false);
}

}  // namespace tessera::view
