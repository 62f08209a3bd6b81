#include "scene/gltf/material_variants.h"

#include <fmt/format.h>
#include <map>
#include <tuple>

namespace tessera
{

static bool lacksTexcoord(const Primitive& primitive, const TextureUse& use)
{
	return use.texcoord >= primitive.texcoords.size() || primitive.texcoords[use.texcoord].empty();
}

std::vector<LostTexture> dropTexturesWithoutTexcoords(ImportedScene& scene)
{
	std::vector<LostTexture> lost;
	std::map<std::tuple<uint32_t, bool, bool>, uint32_t> variants;
	for (size_t m = 0; m < scene.meshes.size(); ++m)
		for (size_t p = 0; p < scene.meshes[m].primitives.size(); ++p)
		{
			Primitive& primitive = scene.meshes[m].primitives[p];
			Material variant = scene.materials[primitive.material];
			const bool no_color = variant.base_color_texture && lacksTexcoord(primitive, *variant.base_color_texture);
			const bool no_height = variant.displacement && lacksTexcoord(primitive, variant.displacement->height);
			if (!no_color && !no_height)
				continue;

			if (no_color)
				lost.push_back(
					{ m, p, fmt::format("has no TEXCOORD_{}: drawn without its base colour texture", variant.base_color_texture->texcoord) });
			if (no_height)
				lost.push_back({ m, p, fmt::format("has no TEXCOORD_{}: drawn without displacement", variant.displacement->height.texcoord) });

			const auto [entry, inserted] =
				variants.try_emplace({ primitive.material, no_color, no_height }, static_cast<uint32_t>(scene.materials.size()));
			if (inserted)
			{
				if (no_color)
					variant.base_color_texture.reset();
				if (no_height)
					variant.displacement.reset();
				variant.variant_of = variant.variant_of.value_or(primitive.material);
				scene.materials.push_back(std::move(variant));
			}
			primitive.material = entry->second;
		}
	return lost;
}

// Moves the kept entries of `items` to the front; returns the new number of each.
template <typename Item>
static std::vector<uint32_t> keepOnly(std::vector<Item>& items, const std::vector<bool>& keep)
{
	std::vector<uint32_t> numbers(items.size(), 0);
	uint32_t kept = 0;
	for (size_t i = 0; i < items.size(); ++i)
	{
		if (!keep[i])
			continue;
		numbers[i] = kept;
		if (kept != i)
			items[kept] = std::move(items[i]);
		++kept;
	}
	items.resize(kept);
	return numbers;
}

void dropUnusedTextures(ImportedScene& scene)
{
	std::vector<bool> material_used(scene.materials.size(), false);
	for (const Mesh& mesh : scene.meshes)
		for (const Primitive& primitive : mesh.primitives)
			material_used[primitive.material] = true;

	std::vector<bool> texture_used(scene.textures.size(), false);
	std::vector<TextureUse*> uses;
	for (size_t i = 0; i < scene.materials.size(); ++i)
	{
		Material& material = scene.materials[i];
		if (!material_used[i])
		{
			material.base_color_texture.reset();
			material.displacement.reset();
		}
		if (material.base_color_texture)
			uses.push_back(&*material.base_color_texture);
		if (material.displacement)
			uses.push_back(&material.displacement->height);
	}
	for (const TextureUse* use : uses)
		texture_used[use->texture] = true;
	const std::vector<uint32_t> texture_numbers = keepOnly(scene.textures, texture_used);
	for (TextureUse* use : uses)
		use->texture = texture_numbers[use->texture];

	std::vector<bool> image_used(scene.images.size(), false);
	for (const Texture& texture : scene.textures)
		image_used[texture.image] = true;
	const std::vector<uint32_t> image_numbers = keepOnly(scene.images, image_used);
	for (Texture& texture : scene.textures)
		texture.image = image_numbers[texture.image];
}

}  // namespace tessera
