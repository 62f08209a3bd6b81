// Materials, height maps and colour textures: what the scene's primitives use of them.
#pragma once
#include "scene/scene.h"

namespace tessera
{

// How the primitives of the scene refer to materials, and which texture coordinates those read.
struct MaterialUses
{
	static constexpr uint32_t kSkipped = NO_INDEX;
	std::vector<std::vector<uint32_t>> materials;        // [mesh][primitive]; kSkipped for meshes that no instance places
	std::vector<std::optional<TextureUse>> height_uses;  // per material of the result; empty: not displaced
	std::vector<std::optional<TextureUse>> color_uses;   // per material of the result; empty: no colour texture

	bool anyHeights() const;
	bool anyColors() const;
};

// Fills in materials, material_height_maps, height_maps, color_textures and warnings of `scene`.
// The first materials are the file's, in its order. A primitive without the texture coordinates that its material reads gets a copy
// of the material without that texture, and a warning. One height map per distinct image, wraps, factor and offset; only what
// some placed triangle uses is decoded.
MaterialUses buildMaterials(const ImportedScene& imported, BuiltScene& scene);

}  // namespace tessera
