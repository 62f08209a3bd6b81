// tinygltf, behind the document's checks.
#pragma once
#include "base/result.h"
#include "scene/gltf/document.h"

#include <tiny_gltf.h>

namespace tessera
{

// The document's description as tinygltf's typed model: fields, defaults, extension values. tinygltf never sees a file name,
// a URI, buffer bytes or an image, so it can open nothing; what it would accept silently the schema has refused before.
// Indices in the model are those of the document. Buffers, images, skins and animations are left empty.
// Errors: BadInput with tinygltf's own words.
Result<tinygltf::Model> parseGltfModel(const GltfDocument& document);

}  // namespace tessera
