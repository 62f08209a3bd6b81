#include "app/camera_path.h"

#include "base/file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tessera
{

using nlohmann::ordered_json;

namespace
{

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr uint64_t kMostBytes = 1u << 26;

ordered_json vectorJson(const dvec3& v)
{
	return { v.x, v.y, v.z };
}

bool readVector(const ordered_json& key, const char* name, dvec3& vector)
{
	const auto found = key.find(name);
	if (found == key.end() || !found->is_array() || found->size() != 3)
		return false;
	for (int axis = 0; axis < 3; ++axis)
	{
		if (!(*found)[size_t(axis)].is_number())
			return false;
		vector[axis] = (*found)[size_t(axis)].get<double>();
	}
	return std::isfinite(glm::length(vector));
}

// Absent or null: nothing.
bool readOptional(const ordered_json& key, const char* name, std::optional<double>& value)
{
	const auto found = key.find(name);
	if (found == key.end() || found->is_null())
		return true;
	if (!found->is_number())
		return false;
	value = found->get<double>();
	return std::isfinite(*value);
}

bool spansView(const Camera& camera)
{
	const dvec3 view = camera.target - camera.eye;
	return glm::length(glm::cross(view, camera.up)) > 1e-9 * glm::length(view) * glm::length(camera.up);
}

Result<CameraKey> readKey(const ordered_json& json, const std::string& where)
{
	CameraKey key;
	std::optional<double> time, fov, near, ortho;
	if (!json.is_object() || !readOptional(json, "time_s", time) || !time || *time < 0)
		return badInput("{}: time_s must be a number from 0", where);
	if (!readVector(json, "eye", key.camera.eye) || !readVector(json, "target", key.camera.target) || !readVector(json, "up", key.camera.up))
		return badInput("{}: eye, target and up must be three finite numbers each", where);
	if (!spansView(key.camera))
		return badInput("{}: eye and target must differ, and up must not lie along the view", where);
	if (!readOptional(json, "fov_deg", fov) || (fov && !(*fov >= 0.01 && *fov <= 179)))
		return badInput("{}: fov_deg must lie between 0.01 and 179", where);
	if (!readOptional(json, "near", near) || (near && *near < 0))
		return badInput("{}: near must be a number from 0", where);
	if (!readOptional(json, "ortho", ortho) || (ortho && !(*ortho > 0)))
		return badInput("{}: ortho must be the height of the view, above 0", where);
	key.time_s = *time;
	key.camera.fov_y_rad = fov ? *fov * kDegree : key.camera.fov_y_rad;
	key.camera.near_world = near.value_or(0);
	key.camera.orthographic = ortho.has_value();
	key.camera.height_world = ortho.value_or(key.camera.height_world);
	return key;
}

}  // namespace

double degreesOf(double radians)
{
	const double degrees = radians / kDegree;
	for (const double candidate : { degrees, std::nextafter(degrees, 0.0), std::nextafter(degrees, 360.0) })
		if (candidate * kDegree == radians)
			return candidate;
	return degrees;
}

Camera between(const Camera& from, const Camera& to, double t)
{
	if (t <= 0)
		return from;
	if (t >= 1)
		return to;
	Camera camera = from;
	camera.eye = glm::mix(from.eye, to.eye, t);
	camera.target = glm::mix(from.target, to.target, t);
	camera.up = glm::mix(glm::normalize(from.up), glm::normalize(to.up), t);
	camera.fov_y_rad = glm::mix(from.fov_y_rad, to.fov_y_rad, t);
	camera.height_world = glm::mix(from.height_world, to.height_world, t);
	return camera;
}

Camera CameraPath::at(double time_s) const
{
	const auto after = std::upper_bound(keys.begin(), keys.end(), time_s, [](double time, const CameraKey& key) { return time < key.time_s; });
	if (after == keys.begin())
		return keys.front().camera;
	const CameraKey& from = *(after - 1);
	if (after == keys.end())
		return from.camera;
	return between(from.camera, after->camera, (time_s - from.time_s) / (after->time_s - from.time_s));
}

Result<CameraPath> readCameraPath(const std::filesystem::path& file)
{
	TRY_ASSIGN(const auto bytes, readFile(file, kMostBytes));
	const auto* text = reinterpret_cast<const char*>(bytes.data());
	const ordered_json json = ordered_json::parse(text, text + bytes.size(), nullptr, false);
	if (json.is_discarded() || !json.is_object() || !json.contains("keys") || !json["keys"].is_array() || json["keys"].empty())
		return badInput("{}: is no camera path: a JSON object with at least one of \"keys\" is right", file.string());
	CameraPath path;
	for (const ordered_json& item : json["keys"])
	{
		const std::string where = fmt::format("{}: key {}", file.string(), path.keys.size());
		TRY_ASSIGN(const CameraKey key, readKey(item, where));
		if (path.keys.empty() ? key.time_s != 0 : !(key.time_s > path.keys.back().time_s))
			return badInput("{}: times must start at 0 and increase", where);
		path.keys.push_back(key);
	}
	return path;
}

std::string cameraPathText(const CameraPath& path)
{
	ordered_json json = { { "schema", 1 }, { "keys", ordered_json::array() } };
	for (const CameraKey& key : path.keys)
	{
		const Camera& camera = key.camera;
		json["keys"].push_back({ { "time_s", key.time_s },
								 { "eye", vectorJson(camera.eye) },
								 { "target", vectorJson(camera.target) },
								 { "up", vectorJson(camera.up) },
								 { "fov_deg", degreesOf(camera.fov_y_rad) },
								 { "near", camera.near_world },
								 { "ortho", camera.orthographic ? ordered_json(camera.height_world) : ordered_json() } });
	}
	return json.dump(1, '\t') + "\n";
}

}  // namespace tessera
