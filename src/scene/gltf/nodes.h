// The node hierarchy of a glTF file, flattened.
#pragma once
#include "base/result.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/model.h"
#include "scene/imported_scene.h"

namespace tessera
{

struct FlatNodes
{
	std::vector<Instance> instances;  // `mesh` is the file's index
	std::vector<FileCamera> cameras;
};

// Walks the file's default scene (the first one when it names none, all root nodes when it has no scenes), iteratively.
// EXT_mesh_gpu_instancing gives several instances of a node's mesh.
// Errors: BadInput (a node reached twice: cycle or two parents; matrix not affine; a world matrix that is not finite;
// rotation of length 0; wrong instancing attributes).
Result<FlatNodes> flattenNodes(GltfDocument& document, const tinygltf::Model& model, const std::vector<GltfAccessor>& accessors);

}  // namespace tessera
