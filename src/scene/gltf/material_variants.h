// What happens to a textured material on a primitive that lacks the texture coordinates for it.
#pragma once
#include "scene/imported_scene.h"

namespace tessera
{

// A texture that a primitive cannot have: scene.meshes[mesh].primitives[primitive], and what is left out.
struct LostTexture
{
	size_t mesh = 0;
	size_t primitive = 0;
	std::string text;
};

// Gives every primitive whose material reads a TEXCOORD set that the primitive lacks a copy of that material without the texture
// or displacement in question (Material::variant_of says whose copy), so that later stages never meet the combination.
std::vector<LostTexture> dropTexturesWithoutTexcoords(ImportedScene& scene);

// Takes the textures from materials that no primitive uses; then removes textures and images that no material uses and
// renumbers the rest in order.
void dropUnusedTextures(ImportedScene& scene);

}  // namespace tessera
