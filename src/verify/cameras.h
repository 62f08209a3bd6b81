// Where a scene is verified from.
#pragma once
#include "scene/camera.h"

#include <string>
#include <vector>

namespace tessera::verify
{

struct NamedCamera
{
	std::string name;
	Camera camera;
};

// `count` random cameras: far, close, inside, grazing, with a narrow and with a wide field of view in turn. The same for the same
// seed on every platform, up to the last bits of sine and cosine. The scene must have triangles.
std::vector<NamedCamera> randomCameras(const BuiltScene& scene, uint64_t seed, uint32_t count);

// The scene's own cameras.
std::vector<NamedCamera> sceneCameras(const BuiltScene& scene);

}  // namespace tessera::verify
