// Scenes and views for the tests of the CPU reference.
#pragma once
#include "base/result.h"
#include "build_test_scenes.h"
#include "reference/classify.h"
#include "scene/camera.h"

#include <memory>

namespace tessera::test
{

// A built scene with what the reference needs of it. Does not move: the reference holds addresses.
struct ReferenceScene
{
	explicit ReferenceScene(const ImportedScene& imported, const TessellationTable& table = defaultTable(), const BuildOptions& options = {});

	BuiltScene built;
	reference::HostScene host;
};
std::unique_ptr<ReferenceScene> builtinScene(std::string_view name, const BuildOptions& options = {});

// One mesh of triangles (corner positions, three each), not displaced, placed by `world`.
ImportedScene triangleScene(const std::vector<vec3>& corners, const dmat4& world = dmat4(1));

// Looks from `eye` to `target` with a focal length of exactly `focal_px` (fov 90 degrees), near 1e-3.
Camera cameraAt(dvec3 eye, dvec3 target);
ViewRequest request(double focal_px, double rate_px);
View viewOf(const ReferenceScene& scene, const Camera& camera, const ViewRequest& request);

// All clusters, classified.
reference::Classified classifyAll(const ReferenceScene& scene, const View& view, uint32_t max_split = 8);

}  // namespace tessera::test
