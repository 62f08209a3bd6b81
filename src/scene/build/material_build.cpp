#include "scene/build/material_build.h"

#include "scene/build/color_texture.h"
#include "scene/build/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

namespace tessera
{

namespace
{

// Makes materials of the result and what they point to, each once.
class MaterialBuilder
{
public:
	MaterialBuilder(const ImportedScene& imported, BuiltScene& scene, MaterialUses& uses) : imported_(imported), scene_(scene), uses_(uses)
	{
		for (const Material& material : imported.materials)
			addMaterial(material);
		used_.resize(imported.materials.size());
	}

	// The material for a primitive; points it to its maps when this is its first use.
	uint32_t materialFor(const Mesh& mesh, const Primitive& primitive)
	{
		const uint32_t index = primitive.material;
		const Material& material = imported_.materials[index];
		const bool wants_height = displaces(index);
		const bool wants_color = material.base_color_texture.has_value();
		const bool height = wants_height && hasCoordinates(primitive, material.displacement->height.texcoord);
		const bool color = wants_color && hasCoordinates(primitive, material.base_color_texture->texcoord);
		if (wants_height && !height)
			warnMissing(mesh, material, "displacement", material.displacement->height.texcoord);
		if (wants_color && !color)
			warnMissing(mesh, material, "base colour texture", material.base_color_texture->texcoord);
		if (height == wants_height && color == wants_color)
		{
			if (!used_[index])
				connect(index, material, height, color);
			used_[index] = true;
			return index;
		}
		return copyOf(index, height, color);
	}

private:
	struct Copy
	{
		uint32_t of;
		bool height, color;
		uint32_t index;
	};

	static bool hasCoordinates(const Primitive& primitive, uint32_t set)
	{
		return set < primitive.texcoords.size() && !primitive.texcoords[set].empty();
	}

	// Asked only of materials that something uses: others may have images that were not decoded.
	bool displaces(uint32_t index)
	{
		if (!imported_.materials[index].displacement)
			return false;
		const auto [entry, is_new] = displaces_.try_emplace(index, false);
		const Displacement& displacement = *imported_.materials[index].displacement;
		if (is_new)
			entry->second = !displacesByNothing(imported_.images[imported_.textures[displacement.height.texture].image], displacement.factor,
												displacement.offset);
		return entry->second;
	}

	void warnMissing(const Mesh& mesh, const Material& material, const char* what, uint32_t set)
	{
		std::string text = fmt::format("{}: mesh \"{}\" has no TEXCOORD_{}, which the {} of material \"{}\" reads: drawn without it", imported_.path,
									   mesh.name, set, what, material.name);
		if (std::find(scene_.warnings.begin(), scene_.warnings.end(), text) == scene_.warnings.end())
			scene_.warnings.push_back(std::move(text));
	}

	uint32_t addMaterial(const Material& material)
	{
		MaterialData data;
		data.name = material.name;
		data.base_color = material.base_color;
		data.metallic = material.metallic;
		data.roughness = material.roughness;
		data.emissive = material.emissive;
		data.double_sided = material.double_sided;
		scene_.materials.push_back(std::move(data));
		scene_.material_height_maps.push_back(NO_INDEX);
		uses_.height_uses.emplace_back();
		uses_.color_uses.emplace_back();
		return uint32_t(scene_.materials.size() - 1);
	}

	// The material without the textures that a primitive has no coordinates for.
	uint32_t copyOf(uint32_t of, bool height, bool color)
	{
		for (const Copy& copy : copies_)
			if (copy.of == of && copy.height == height && copy.color == color)
				return copy.index;
		const uint32_t index = addMaterial(imported_.materials[of]);
		connect(index, imported_.materials[of], height, color);
		copies_.push_back({ of, height, color, index });
		return index;
	}

	void connect(uint32_t index, const Material& material, bool height, bool color)
	{
		if (height)
		{
			uses_.height_uses[index] = material.displacement->height;
			scene_.materials[index].height_map = heightMap(*material.displacement);
			scene_.material_height_maps[index] = scene_.materials[index].height_map;
		}
		if (color)
		{
			uses_.color_uses[index] = material.base_color_texture;
			scene_.materials[index].base_color_texture = colorTexture(imported_.textures[material.base_color_texture->texture]);
		}
	}

	uint32_t heightMap(const Displacement& displacement)
	{
		const Texture& texture = imported_.textures[displacement.height.texture];
		const HeightMapData* same_image = nullptr;
		for (uint32_t i = 0; i < scene_.height_maps.size(); ++i)
		{
			if (height_images_[i] != texture.image)
				continue;
			const HeightMap& record = scene_.height_maps[i].record;
			same_image = &scene_.height_maps[i];
			if (record.wrap_u == uint32_t(texture.wrap_u) && record.wrap_v == uint32_t(texture.wrap_v) && record.factor == displacement.factor &&
				record.offset == displacement.offset)
				return i;
		}
		HeightMapData map =
			same_image ? *same_image : buildHeightMap(imported_.images[texture.image], texture, displacement.factor, displacement.offset);
		map.record.wrap_u = uint32_t(texture.wrap_u);
		map.record.wrap_v = uint32_t(texture.wrap_v);
		map.record.factor = displacement.factor;
		map.record.offset = displacement.offset;
		scene_.height_maps.push_back(std::move(map));
		height_images_.push_back(texture.image);
		return uint32_t(scene_.height_maps.size() - 1);
	}

	uint32_t colorTexture(const Texture& texture)
	{
		for (uint32_t i = 0; i < scene_.color_textures.size(); ++i)
		{
			const ColorTexture& other = scene_.color_textures[i];
			if (color_images_[i] == texture.image && other.wrap_u == texture.wrap_u && other.wrap_v == texture.wrap_v &&
				other.nearest == texture.nearest)
				return i;
		}
		scene_.color_textures.push_back(buildColorTexture(imported_.images[texture.image], texture));
		color_images_.push_back(texture.image);
		return uint32_t(scene_.color_textures.size() - 1);
	}

	const ImportedScene& imported_;
	BuiltScene& scene_;
	MaterialUses& uses_;
	std::unordered_map<uint32_t, bool> displaces_;  // by imported material, once asked
	std::vector<bool> used_;                        // per imported material
	std::vector<Copy> copies_;
	std::vector<uint32_t> height_images_;  // parallel to the scene's height maps
	std::vector<uint32_t> color_images_;   // parallel to its colour textures
};

}  // namespace

bool MaterialUses::anyHeights() const
{
	return std::any_of(height_uses.begin(), height_uses.end(), [](const auto& use) { return use.has_value(); });
}

bool MaterialUses::anyColors() const
{
	return std::any_of(color_uses.begin(), color_uses.end(), [](const auto& use) { return use.has_value(); });
}

MaterialUses buildMaterials(const ImportedScene& imported, BuiltScene& scene)
{
	MaterialUses uses;
	MaterialBuilder builder(imported, scene, uses);
	std::vector<bool> placed(imported.meshes.size());
	for (const Instance& instance : imported.instances)
		placed[instance.mesh] = true;
	for (size_t mesh_index = 0; mesh_index < imported.meshes.size(); ++mesh_index)
	{
		const Mesh& mesh = imported.meshes[mesh_index];
		std::vector<uint32_t>& materials = uses.materials.emplace_back(mesh.primitives.size(), MaterialUses::kSkipped);
		for (size_t i = 0; placed[mesh_index] && i < mesh.primitives.size(); ++i)
			if (!mesh.primitives[i].indices.empty())
				materials[i] = builder.materialFor(mesh, mesh.primitives[i]);
	}
	return uses;
}

}  // namespace tessera
