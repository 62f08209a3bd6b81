// KHR_draco_mesh_compression, resolved before the model is read.
#pragma once
#include "base/result.h"
#include "scene/gltf/document.h"

namespace tessera
{

// Decodes every Draco-compressed primitive of the document into plain buffers, buffer views and accessors, so that later
// stages see an ordinary file. (tinygltf's own decoding reads out of bounds when a stream lacks a named attribute.)
// Errors: BadInput naming the primitive (broken stream, missing attribute, other component count than the accessor's).
Status decodeDraco(GltfDocument& document);

}  // namespace tessera
