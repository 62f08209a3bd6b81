// glTF 2.0 files (.gltf, .glb) into an ImportedScene. What is supported, warned about and refused: docs/formats.md.
#pragma once
#include "base/result.h"
#include "scene/imported_scene.h"

#include <filesystem>

namespace tessera
{

// Reads the file, validates everything it points at, and decodes what a picture of its default scene needs: meshes that a node
// draws, the vertex attributes their materials use, and the images of those materials (in parallel).
// The result keeps every promise of imported_scene.h; materials keep the file's order, so that indices mean the same.
// Errors: BadInput, one line: file, place, what is wrong, what would be right. Also when nothing drawable remains.
// Time linear in the file; about 1 s for ten million triangles.
Result<ImportedScene> importGltf(const std::filesystem::path& path);

// The same for a file that is in memory already, as if it lay at `path`.
Result<ImportedScene> importGltf(const std::filesystem::path& path, std::vector<std::byte> bytes);

}  // namespace tessera
