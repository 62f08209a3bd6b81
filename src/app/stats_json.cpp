#include "app/stats_json.h"

#include "base/file.h"
#include "pipeline/passes.h"
#include "plan/conditions.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tessera
{

using nlohmann::ordered_json;

namespace
{

ordered_json timesJson(const TimeSeries& series)
{
	const auto toNanoseconds = [](double ms) {
		return std::round(ms * 1e6) / 1e6;
	};
	return { { "median", toNanoseconds(series.median()) }, { "min", toNanoseconds(series.least()) }, { "max", toNanoseconds(series.most()) } };
}

ordered_json frameJson(const RunFacts& facts)
{
	const FrameResult& last = facts.series.last;
	const FrameCountsRead& counts = last.counts;
	return {
		{ "frames", facts.series.frame.gpu_ms.size() },
		{ "gpu_ms", timesJson(facts.series.frame) },
		{ "raster", rasterName(chosenRaster(facts.input)) },
		{ "raster_reason", rasterChoice(facts.input).reason },
		{ "rate_wanted", last.rate_wanted },
		{ "rate_granted", last.rate_granted },
		{ "coarsening", last.coarsening },
		{ "every_factor_one", last.every_factor_one },
		{ "rounds", last.rounds },
		{ "attempts", last.attempts },
		{ "visible_clusters", counts.visible_clusters },
		{ "full_clusters", counts.full_clusters },
		{ "part_triangles", counts.part_triangles },
		{ "split_triangles", counts.split_triangles },
		{ "micro_triangles", counts.micro_triangles },
		{ "hidden_parts", counts.hidden_parts },
		{ "revealed_parts", counts.revealed_parts },
		{ "hidden_clusters", counts.hidden_clusters },
		{ "revealed_clusters", counts.revealed_clusters },
		{ "covered_pixels", counts.covered_pixels },
	};
}

// Every pass there is, in execution order: its time, or why it did not run.
ordered_json passesJson(const RunFacts& facts)
{
	ordered_json json = ordered_json::object();
	for (const PassDesc* pass : framePasses())
	{
		const std::string name(pass->name);
		const auto found = facts.series.passes.find(name);
		if (found != facts.series.passes.end())
			json[name]["gpu_ms"] = timesJson(found->second);
		else
			json[name]["dropped"] = facts.plan.reason(name);
	}
	return json;
}

ordered_json listsJson(const FrameResult& result)
{
	ordered_json json = ordered_json::object();
	for (const ListStats& list : result.lists)
		json[list.name] = {
			{ "wanted", list.wanted }, { "capacity", list.capacity }, { "peak", list.peak }, { "bytes", list.bytes }, { "peak_used", list.peak_used },
		};
	return json;
}

ordered_json clustersJson(const RayClusterStats& clusters)
{
	return {
		{ "templates", clusters.templates },
		{ "template_instantiations", clusters.full + clusters.parts },
		{ "full_clusters", clusters.full },
		{ "part_triangles", clusters.parts },
		{ "transient_1x1x1", clusters.units },
		{ "transient_2x2x2", clusters.groups },
		{ "structures", clusters.structures },
		{ "generated_vertices", clusters.generated_vertices },
		{ "template_bytes", clusters.template_bytes },
		{ "cluster_bytes", clusters.data_bytes },
		{ "cluster_used_bytes", clusters.data_used_bytes },
		{ "structure_bytes", clusters.structure_bytes },
		{ "structure_used_bytes", clusters.structure_used_bytes },
		{ "operation_bytes", clusters.operation_bytes },
	};
}

ordered_json trianglesJson(const RayStats& rays)
{
	return {
		{ "triangles", rays.triangles.wanted },         { "reserved_triangles", rays.triangles.capacity },
		{ "geometry_bytes", rays.geometry_bytes },      { "geometry_used_bytes", rays.geometry_used_bytes },
		{ "build", rays.refitted ? "refit" : "built" }, { "shared_structures", rays.shared_structures },
		{ "shared_instances", rays.shared_instances },  { "shared_bytes", rays.shared_bytes },
	};
}

ordered_json raysJson(const RunFacts& facts)
{
	const RayStats& rays = facts.series.last.rays;
	const RayPathChoice path = rayPathChoice(facts.input);
	ordered_json json = {
		{ "path", path.clusters ? "clusters" : "khr" },
		{ "path_reason", path.reason },
		{ "scene_bytes", rays.scene_bytes },
		{ "scratch_bytes", rays.scratch_bytes },
		{ "falloff", kRayFalloff.holds(facts.input) ? facts.input.options.ray_falloff : 0 },
		{ "hidden_instances", facts.series.last.counts.hidden_instances },
		{ "hidden_redraws", facts.series.hidden_redraws },
	};
	json.update(rays.clusters.built ? clustersJson(rays.clusters) : trianglesJson(rays));
	return json;
}

ordered_json vectorJson(const dvec3& vector)
{
	return ordered_json::array({ vector.x, vector.y, vector.z });
}

ordered_json cameraJson(const Camera& camera, const BuiltScene& scene)
{
	ordered_json json = {
		{ "eye", vectorJson(camera.eye) },       { "target", vectorJson(camera.target) }, { "up", vectorJson(camera.up) },
		{ "near", nearDistance(camera, scene) }, { "orthographic", camera.orthographic },
	};
	if (camera.orthographic)
		json["height"] = camera.height_world;
	else
		json["fov"] = glm::degrees(camera.fov_y_rad);
	return json;
}

}  // namespace

double TimeSeries::median() const
{
	if (gpu_ms.empty())
		return 0;
	std::vector<double> sorted = gpu_ms;
	std::sort(sorted.begin(), sorted.end());
	const size_t middle = sorted.size() / 2;
	return sorted.size() % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

double TimeSeries::least() const
{
	return gpu_ms.empty() ? 0 : *std::min_element(gpu_ms.begin(), gpu_ms.end());
}

double TimeSeries::most() const
{
	return gpu_ms.empty() ? 0 : *std::max_element(gpu_ms.begin(), gpu_ms.end());
}

void FrameSeries::add(const FrameResult& result)
{
	frame.gpu_ms.push_back(result.gpu_ms);
	for (const PassTime& pass : result.passes)
		passes[pass.name].gpu_ms.push_back(pass.gpu_ms);
	hidden_redraws += result.hidden_redraws;
	last = result;
}

ordered_json deviceJson(const Device& device)
{
	ordered_json gates = ordered_json::object();
	for (const Gate& gate : device.gates.table())
		gates[std::string(gate.name)] = gate.open;
	return { { "name", device.name },
			 { "driver", device.driver },
			 { "api", device.api },
			 { "subgroup_size", device.limits.subgroup_size },
			 { "gates", gates } };
}

ordered_json sceneJson(const BuiltScene& scene)
{
	const SceneTraits& traits = scene.traits;
	return {
		{ "path", scene.path },
		{ "instances", scene.instances.size() },
		{ "clusters", scene.clusters.size() },
		{ "base_triangles", traits.base_triangles },
		{ "instanced_triangles", traits.instanced_triangles },
		{ "vertices", scene.positions.size() },
		{ "meshes", scene.meshes.size() },
		{ "materials", scene.materials.size() },
		{ "height_maps", scene.height_maps.size() },
		{ "color_textures", scene.color_textures.size() },
		{ "cameras", scene.cameras.size() },
		{ "degenerate_triangles", traits.degenerate_triangles },
		{ "seam_edges", traits.seam_edges },
		{ "seam_corners", traits.seam_corners },
		{ "zero_directions", traits.zero_directions },
		{ "boundary_edges", traits.boundary_edges },
		{ "nonmanifold_edges", traits.nonmanifold_edges },
		{ "world_low", vectorJson(scene.world_low) },
		{ "world_high", vectorJson(scene.world_high) },
		{ "warnings", scene.warnings },
	};
}

ordered_json statsJson(const RunFacts& facts)
{
	ordered_json json;
	json["schema"] = 1;
	json["device"] = deviceJson(facts.device);
	json["scene"] = sceneJson(facts.scene);
	json["options"] = optionsJson(facts.options);
	json["camera"] = cameraJson(facts.camera, facts.scene);
	json["frame"] = frameJson(facts);
	json["passes"] = passesJson(facts);
	json["lists"] = listsJson(facts.series.last);
	if (facts.series.last.rays.traced)
		json["rays"] = raysJson(facts);
	json["memory"] = {
		{ "lists", facts.memory.lists },   { "geometry", facts.memory.geometry }, { "textures", facts.memory.textures },
		{ "images", facts.memory.images }, { "rays", facts.memory.rays },         { "total", facts.memory.total() },
	};
	return json;
}

Status writeJson(const std::filesystem::path& path, const ordered_json& json)
{
	// Names from files may hold any bytes: what is not UTF-8 is replaced.
	const std::string text = json.dump(1, '\t', false, ordered_json::error_handler_t::replace) + "\n";
	if (path != "-")
		return writeFile(path, std::string_view(text));
	if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
		return badInput("standard output: cannot be written to");
	return {};
}

}  // namespace tessera
