#include "app/commands.h"
#include "app/plan_json.h"
#include "app/scene_load.h"
#include "app/stats_json.h"
#include "frame/renderer.h"

#include <cstdio>

namespace tessera
{

using nlohmann::ordered_json;

namespace
{

// A scene, and what planning its frame needs beside it.
struct SceneInfo
{
	BuiltScene scene;
	TessellationTable table;
	Camera camera;
	std::optional<ScenePlan> planned;  // only when it was asked for
};

Result<SceneInfo> inspectScene(const CommandLine& line)
{
	SceneInfo info;
	TRY_ASSIGN(info.table, loadChosenTable(line.options));
	TRY_ASSIGN(info.scene, loadScene(line.scene, line.options));
	TRY_ASSIGN(info.camera, chooseCamera(info.scene, line.options));
	return info;
}

std::string deviceText(const Device& device)
{
	std::string text =
		fmt::format("device    {}\ndriver    {}\nVulkan    {}\nsubgroup  {}\n", device.name, device.driver, device.api, device.limits.subgroup_size);
	text += "required  every feature that tessera cannot do without is there\ngates\n";
	for (const Gate& gate : device.gates.table())
		text += fmt::format("  {:<32} {}\n", gate.name,
							gate.open          ? std::string("open")
							: gate.why.empty() ? fmt::format("closed: {}", gate.instead)
											   : fmt::format("closed ({}): {}", gate.why, gate.instead));
	return text;
}

std::string yesOrNo(bool yes)
{
	return yes ? "yes" : "no";
}

std::string sceneText(const BuiltScene& scene)
{
	const SceneTraits& traits = scene.traits;
	const dvec3& low = scene.world_low;
	const dvec3& high = scene.world_high;
	std::string text = fmt::format("scene     {}\n", scene.path);
	const auto row = [&](std::string_view name, const std::string& value) {
		text += fmt::format("  {:<32} {}\n", name, value);
	};
	row("instances", fmt::format("{} of {} meshes", scene.instances.size(), scene.meshes.size()));
	row("base triangles",
		fmt::format("{} ({} over all instances, {} of no area)", traits.base_triangles, traits.instanced_triangles, traits.degenerate_triangles));
	row("vertices, clusters", fmt::format("{}, {}", scene.positions.size(), scene.clusters.size()));
	row("materials",
		fmt::format("{}, with {} height maps and {} colour textures", scene.materials.size(), scene.height_maps.size(), scene.color_textures.size()));
	row("displaced", yesOrNo(traits.has_displacement));
	row("seams", fmt::format("{} edges, {} corners", traits.seam_edges, traits.seam_corners));
	row("open and non-manifold edges", fmt::format("{}, {}", traits.boundary_edges, traits.nonmanifold_edges));
	row("cameras", fmt::format("{}", scene.cameras.size()));
	row("world bounds", fmt::format("{:.6g},{:.6g},{:.6g} to {:.6g},{:.6g},{:.6g}", low.x, low.y, low.z, high.x, high.y, high.z));
	return text;
}

Status printJson(const CommandLine& line, const Device& device, const std::optional<SceneInfo>& info)
{
	ordered_json json = { { "schema", 1 }, { "device", deviceJson(device) } };
	for (const Gate& gate : device.gates.table())
	{
		if (!gate.open)
			json["device"]["instead"][std::string(gate.name)] = gate.instead;
		if (!gate.open && !gate.why.empty())
			json["device"]["why_closed"][std::string(gate.name)] = gate.why;
	}
	if (info)
		json["scene"] = sceneJson(info->scene);
	json["options"] = optionsJson(line.options);
	if (info && info->planned)
		json["plan"] = planJson(*info->planned);
	return writeJson("-", json);
}

}  // namespace

Status infoCommand(const CommandLine& line)
{
	std::optional<SceneInfo> info;
	if (!line.scene.empty() || line.print_plan)
	{
		TRY_ASSIGN(info, inspectScene(line));
	}
	TRY_ASSIGN(const std::unique_ptr<Device> device, Device::create({ line.options.device, line.options.validate }));
	if (line.print_plan)
	{
		TRY_ASSIGN(info->planned, planScene(info->scene, info->camera, line.options, traitsOf(*device), info->table));
	}
	if (line.json)
		return printJson(line, *device, info);
	std::string text = deviceText(*device);
	if (info)
		text += sceneText(info->scene);
	if (info && info->planned)
		text += planText(*info->planned);
	std::fputs(text.c_str(), stdout);
	return {};
}

}  // namespace tessera
