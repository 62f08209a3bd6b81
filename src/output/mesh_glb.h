// glTF 2.0 binary files (.glb). Source of the format: Khronos, glTF 2.0 Specification, section 4.
#pragma once
#include "output/mesh_ply.h"
#include "scene/imported_scene.h"

namespace tessera
{

// Writes everything of a scene into one file: meshes, materials (KHR_materials_displacement, KHR_texture_transform where it is not the
// identity), textures (images as embedded PNG of 8 or 16 bits, float ones as OpenEXR), instances as nodes, cameras. Importing it gives the same scene
// back: floats, texels and matrices are stored exactly. Left out: the scene's warnings and path. Errors: BadInput (path and reason: more than 4 GiB,
// a texture transform that KHR_texture_transform cannot say, because it shears); no partial file is left.
Status writeSceneGlb(const std::filesystem::path& path, const ImportedScene& scene);

// The bytes of that file. `name` stands in messages. Errors: as above.
Result<std::vector<std::byte>> encodeSceneGlb(const std::string& name, const ImportedScene& scene);

// Writes one plain mesh with one node and a default material.
// Errors: BadInput (path and reason: more than 4 GiB); no partial file is left.
Status writeMeshGlb(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace tessera
