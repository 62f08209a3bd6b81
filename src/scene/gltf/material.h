// Materials, textures and samplers of a glTF file.
#pragma once
#include "base/result.h"
#include "scene/gltf/model.h"
#include "scene/imported_scene.h"

namespace tessera
{

// All materials of the file, in its order. The texture indices in them are still the file's own.
// What they ask for and is not drawn (normal maps, blending, ...) goes into document.warnings.
// Errors: BadInput (numbers that are not finite as float).
Result<std::vector<Material>> importMaterials(GltfDocument& document, const tinygltf::Model& model);

// Keeps the textures and images that the primitives in `scene` use, renumbers them, and decodes the images in parallel.
// Materials that no primitive uses lose their textures.
// Errors: BadInput naming texture or image (no source, unsupported or broken image).
Status importTextures(GltfDocument& document, const tinygltf::Model& model, ImportedScene& scene);

}  // namespace tessera
