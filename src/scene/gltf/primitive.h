// One primitive of a glTF mesh into triangles.
#pragma once
#include "base/result.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/model.h"
#include "scene/imported_scene.h"

#include <optional>
#include <set>

namespace tessera
{

struct PrimitiveInput
{
	const GltfDocument& document;
	const std::vector<GltfAccessor>& accessors;  // one per accessor of the model
	const tinygltf::Primitive& source;
	std::string place;                    // "meshes[2].primitives[0]"
	uint32_t material = 0;                // index that the result carries
	std::set<uint32_t> texcoords_wanted;  // sets to read when the primitive has them
};

// Triangles, strips and fans become indexed triangles; vertices that no triangle uses are left out, the others keep their order.
// Nothing when the primitive has no triangles (points, lines, too few indices, no POSITION): a warning says so.
// Errors: BadInput (wrong accessor type, attributes of different lengths, index out of range, position that is not finite).
Result<std::optional<Primitive>> importPrimitive(const PrimitiveInput& input, GltfWarnings& warnings);

}  // namespace tessera
