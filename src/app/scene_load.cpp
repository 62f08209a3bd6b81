#include "app/scene_load.h"

#include "app/camera_path.h"
#include "app/list_options.h"
#include "app/option_text.h"
#include "base/check.h"
#include "base/log.h"
#include "scene/build.h"
#include "scene/builtin.h"
#include "scene/displacement_option.h"
#include "scene/gltf_import.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace tessera
{

namespace
{

constexpr uint64_t kMostInstances = 1u << 24;
constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kGridGap = 1.1;  // step from copy to copy, in sizes of the scene

bool isBuiltin(std::string_view scene)
{
	return scene.empty() || scene.starts_with("builtin:");
}

// Farthest that a material moves a vertex, in mesh units; heights of float images are taken for 0..1 too.
double displacementReach(const Material& material, double displacement_offset)
{
	if (!material.displacement)
		return 0;
	const double offset = double(material.displacement->offset) + displacement_offset;
	return std::max(std::abs(offset), std::abs(offset + double(material.displacement->factor)));
}

// Size of the scene in the world, displaced as far as it can be.
dvec3 worldSize(const ImportedScene& scene, const AppOptions& options)
{
	constexpr double kInfinity = std::numeric_limits<double>::infinity();
	dvec3 low(kInfinity), high(-kInfinity);
	for (const Instance& instance : scene.instances)
		for (const Primitive& primitive : scene.meshes[instance.mesh].primitives)
		{
			const dmat3 axes = dmat3(instance.world);
			const double scale = std::max({ glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]) });
			const double reach = displacementReach(scene.materials[primitive.material], double(options.displacement_offset)) *
								 std::abs(double(options.displacement_scale)) * scale;
			for (const vec3& position : primitive.positions)
			{
				const dvec3 world = dvec3(instance.world * dvec4(dvec3(position), 1));
				low = glm::min(low, world - reach);
				high = glm::max(high, world + reach);
			}
		}
	return glm::max(high - low, dvec3(0));
}

Status copyOverGrid(ImportedScene& scene, const AppOptions& options)
{
	const uint64_t copies = uint64_t(options.grid_columns) * options.grid_rows;
	if (copies == 1)
		return {};
	if (copies * scene.instances.size() > kMostInstances)
		return fail(ExitCode::Usage, "--grid {}x{}: {} has {} instances, copies would be {}; at most {} can be drawn", options.grid_columns,
					options.grid_rows, scene.path, scene.instances.size(), copies * scene.instances.size(), kMostInstances);
	const bool needs_size = !options.grid_u || !options.grid_v;
	const dvec3 size = needs_size ? worldSize(scene, options) * kGridGap : dvec3(0);
	const dvec3 u = options.grid_u.value_or(dvec3(size.x, 0, 0)), v = options.grid_v.value_or(dvec3(0, 0, -size.z));
	std::vector<Instance> instances;
	instances.reserve(copies * scene.instances.size());
	for (uint32_t i = 0; i < options.grid_columns; ++i)
		for (uint32_t j = 0; j < options.grid_rows; ++j)
			for (const Instance& instance : scene.instances)
				instances.push_back({ instance.mesh, glm::translate(dmat4(1), double(i) * u + double(j) * v) * instance.world });
	scene.instances = std::move(instances);
	return {};
}

// A camera that shows the whole scene in a picture of this shape.
Camera frameScene(const BuiltScene& scene, const AppOptions& options)
{
	Camera camera = framingCamera(scene);  // for a square view
	const double square_slope = std::tan(camera.fov_y_rad / 2);
	camera.fov_y_rad = options.fov_deg ? *options.fov_deg * kDegree : camera.fov_y_rad;
	const double slope = std::tan(camera.fov_y_rad / 2) * std::min(1.0, double(options.width_px) / options.height_px);
	// A narrower view is moved back in proportion; a wider one comes nearer, as far as the bounding sphere allows.
	const dvec3 backward = camera.eye - camera.target;
	const double distance = glm::length(backward), sphere_distance = boundingRadius(scene) / std::sin(std::atan(slope));
	camera.eye = camera.target + backward / distance * (slope < square_slope ? distance * square_slope / slope : std::min(distance, sphere_distance));
	return camera;
}

Result<Camera> baseCamera(const BuiltScene& scene, const AppOptions& options)
{
	const size_t count = scene.cameras.size();
	const bool own = isBuiltin(scene.path) && count > 0 && options.grid_columns * options.grid_rows == 1;
	if (!options.camera && !own)
		return frameScene(scene, options);
	const size_t index = options.camera.value_or(0);
	if (index >= count)
		return fail(ExitCode::Usage, "--camera {}: {} has {}{}", index, scene.path, counted(count, "camera"),
					count ? fmt::format(", 0 to {}", count - 1) : "; leave --camera out to frame the scene");
	return cameraOf(scene.cameras[index], scene);
}

}  // namespace

BuildOptions buildOptionsOf(const AppOptions& options)
{
	BuildOptions build = { options.cluster_vertices, options.cluster_triangles, {} };
	for (const Metric metric : metricsOf(options))
		build.tables.include(metric);
	build.tables.include(options.metric);
	build.pn = options.pn;
	return build;
}

Result<ImportedScene> importScene(const std::string& scene, const AppOptions& options)
{
	const std::string name = scene.empty() ? fmt::format("builtin:{}", builtinScenes()[0].name) : scene;
	setWorkingOn(name);
	logInfo("loading {}", name);
	TRY_ASSIGN(ImportedScene imported, isBuiltin(name) ? makeBuiltinScene(name) : importGltf(name));
	for (const std::string& displacement : options.displacements)
		TRY(attachDisplacement(imported, displacement));
	TRY(copyOverGrid(imported, options));
	return imported;
}

Result<BuiltScene> loadScene(const std::string& scene, const AppOptions& options)
{
	TRY_ASSIGN(const ImportedScene imported, importScene(scene, options));
	TRY_ASSIGN(BuiltScene built, buildScene(imported, buildOptionsOf(options)));
	for (const std::string& warning : built.warnings)
		logWarning("{}", warning);
	logInfo("built {} in {}; {} of {} in all", counted(built.traits.base_triangles, "triangle"), counted(built.clusters.size(), "cluster"),
			counted(built.instances.size(), "instance"), counted(built.traits.instanced_triangles, "triangle"));
	return built;
}

Result<TessellationTable> loadChosenTable(const AppOptions& options)
{
	return options.table.empty() ? Result<TessellationTable>(defaultTable()) : loadTable(options.table);
}

static Result<Camera> withOptions(Camera camera, const BuiltScene& scene, const AppOptions& options)
{
	if (options.eye && !options.target)
		camera.target = (scene.world_low + scene.world_high) / 2.0;
	camera.eye = options.eye.value_or(camera.eye);
	camera.target = options.target.value_or(camera.target);
	camera.up = options.up.value_or(camera.up);
	camera.near_world = options.near_world.value_or(camera.near_world);
	if (options.fov_deg)
	{
		camera.fov_y_rad = *options.fov_deg * kDegree;
		camera.orthographic = false;
	}
	if (options.ortho_world)
	{
		camera.orthographic = true;
		camera.height_world = *options.ortho_world;
	}
	const dvec3 view = camera.target - camera.eye;
	if (!(glm::length(view) > 0))
		return fail(ExitCode::Usage, "--eye {} is also the target: they must differ", printVector(camera.eye));
	const auto alongView = [&] {
		return glm::length(glm::cross(view, camera.up)) <= 1e-9 * glm::length(view) * glm::length(camera.up);
	};
	if (alongView() && !options.up)
		camera.up = { 0, 0, -1 };  // straight up or down: as a map, north is up
	if (alongView())
		return fail(ExitCode::Usage, "--up {}: must be neither zero nor along the view", printVector(camera.up));
	return camera;
}

Result<Camera> chooseCamera(const BuiltScene& scene, const AppOptions& options)
{
	TRY_ASSIGN(Camera camera, baseCamera(scene, options));
	if (!options.camera_path.empty())
	{
		TRY_ASSIGN(const CameraPath path, readCameraPath(options.camera_path));
		camera = path.at(0);
	}
	return withOptions(camera, scene, options);
}

Result<std::vector<Camera>> chooseCameras(const BuiltScene& scene, const AppOptions& options)
{
	std::vector<Camera> cameras;
	if (options.camera_path.empty())
	{
		TRY_ASSIGN(cameras.emplace_back(), chooseCamera(scene, options));
		return cameras;
	}
	TRY_ASSIGN(const CameraPath path, readCameraPath(options.camera_path));
	for (const CameraKey& key : path.keys)
	{
		TRY_ASSIGN(cameras.emplace_back(), withOptions(key.camera, scene, options));
	}
	return cameras;
}

Result<Subject> loadSubject(const std::string& scene, const AppOptions& options)
{
	Subject subject;
	TRY_ASSIGN(subject.table, loadChosenTable(options));
	TRY_ASSIGN(subject.scene, loadScene(scene, options));
	TRY_ASSIGN(subject.camera, chooseCamera(subject.scene, options));
	return subject;
}

}  // namespace tessera
