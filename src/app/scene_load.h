// From what the command line names to a built scene and a camera.
#pragma once
#include "app/options.h"
#include "scene/build.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "tables/table.h"

namespace tessera
{

// Reads a file or makes a built-in scene (empty name: the default one), attaches displacement and copies it over the grid.
// Errors: those of importGltf, makeBuiltinScene and attachDisplacement; Usage when the grid has too many instances.
Result<ImportedScene> importScene(const std::string& scene, const AppOptions& options);

// What buildScene is asked for: sizes of clusters, tables of the metrics, PN triangles.
BuildOptions buildOptionsOf(const AppOptions& options);

// importScene and buildScene; says what it does, and prints the scene's warnings.
Result<BuiltScene> loadScene(const std::string& scene, const AppOptions& options);

// The table that is built in, or the one of --table.
Result<TessellationTable> loadChosenTable(const AppOptions& options);

// --camera N, else a built-in scene's own camera, else one that shows the whole scene; then --eye, --target, --up, --fov and
// --near over it. Errors: Usage (no such camera, options that do not span a view).
Result<Camera> chooseCamera(const BuiltScene& scene, const AppOptions& options);

// That of every key of --camera-path, --eye and the others over each; without a path the one of chooseCamera. Errors: as chooseCamera, and those of
// the file.
Result<std::vector<Camera>> chooseCameras(const BuiltScene& scene, const AppOptions& options);

// What a frame is drawn of, found before the device is needed.
struct Subject
{
	TessellationTable table;
	BuiltScene scene;
	Camera camera;
};

// The table, scene and camera that the options name. Errors: those of the three.
Result<Subject> loadSubject(const std::string& scene, const AppOptions& options);

}  // namespace tessera
