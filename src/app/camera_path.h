// Cameras over time: recorded and played in the viewer, drawn by `render --camera-path`, as JSON.
#pragma once
#include "base/result.h"
#include "scene/camera.h"

#include <filesystem>
#include <vector>

namespace tessera
{

struct CameraKey
{
	double time_s = 0;
	Camera camera;
};

// Keys in the order of time, at least one, the first at 0.
struct CameraPath
{
	std::vector<CameraKey> keys;

	double duration_s() const { return keys.empty() ? 0 : keys.back().time_s; }
	// The camera at a time; before the first key and after the last it is theirs. Eye, target and field of view go straight from key to key; at a key
	// it is the key's, bit for bit.
	Camera at(double time_s) const;
};

// { "schema": 1, "keys": [ { "time_s": 0, "eye": [x, y, z], "target": [...], "up": [...], "fov_deg": 60, "near": 0, "ortho": null } ] }
// near and ortho may be missing. Errors: BadInput with the file and the place in it.
Result<CameraPath> readCameraPath(const std::filesystem::path& file);
// The text that readCameraPath reads the same from, bit for bit.
std::string cameraPathText(const CameraPath& path);

// `t` of the way from one camera to the other, 0..1: eyes and targets on straight lines, fields of view in proportion.
Camera between(const Camera& from, const Camera& to, double t);

// Degrees that become the same bits again when they are made radians: the quotient may be a step off.
double degreesOf(double radians);

}  // namespace tessera
