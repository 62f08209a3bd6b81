#include "scene/gltf/material.h"

#include <algorithm>
#include <cmath>

namespace tessera
{

using tinygltf::Value;

static constexpr const char* kDisplacementExtension = "KHR_materials_displacement";
static constexpr const char* kTransformExtension = "KHR_texture_transform";

static double numberOr(const Value& object, const char* name, double otherwise)
{
	return object.Has(name) ? object.Get(name).GetNumberAsDouble() : otherwise;
}

static dvec2 pairOr(const Value& object, const char* name, dvec2 otherwise)
{
	return object.Has(name) ? dvec2(object.Get(name).Get(0).GetNumberAsDouble(), object.Get(name).Get(1).GetNumberAsDouble()) : otherwise;
}

// translation * rotation * scale. A positive rotation turns UVs counter-clockwise as seen with v pointing down, which is the
// extension's text and its sample model; its GLSL listing has the opposite sign.
static void applyTransform(const Value& transform, TextureUse& use)
{
	const dvec2 offset = pairOr(transform, "offset", { 0, 0 });
	const dvec2 scale = pairOr(transform, "scale", { 1, 1 });
	const double rotation = numberOr(transform, "rotation", 0);
	const double c = std::cos(rotation);
	const double s = std::sin(rotation);
	use.row0 = { c * scale.x, s * scale.y, offset.x };
	use.row1 = { -s * scale.x, c * scale.y, offset.y };
	if (transform.Has("texCoord"))
		use.texcoord = static_cast<uint32_t>(transform.Get("texCoord").GetNumberAsInt());
}

static Status checkTransform(const GltfDocument& document, const std::string& place, const TextureUse& use)
{
	for (const dvec3& row : { use.row0, use.row1 })
		for (const double value : { row.x, row.y, row.z })
			if (!std::isfinite(static_cast<float>(value)))
				return document.bad(fmt::format("{}.extensions.{}", place, kTransformExtension), "is too large for a 32-bit float");
	return {};
}

static Result<TextureUse> textureUse(const GltfDocument& document, const std::string& place, const Value& info)
{
	TextureUse use;
	use.texture = static_cast<uint32_t>(info.Get("index").GetNumberAsInt());
	use.texcoord = static_cast<uint32_t>(numberOr(info, "texCoord", 0));
	if (info.Has("extensions") && info.Get("extensions").Has(kTransformExtension))
		applyTransform(info.Get("extensions").Get(kTransformExtension), use);
	TRY(checkTransform(document, place, use));
	return use;
}

static Result<TextureUse> textureUse(const GltfDocument& document, const std::string& place, const tinygltf::TextureInfo& info)
{
	TextureUse use;
	use.texture = static_cast<uint32_t>(info.index);
	use.texcoord = static_cast<uint32_t>(info.texCoord);
	if (const auto transform = info.extensions.find(kTransformExtension); transform != info.extensions.end())
		applyTransform(transform->second, use);
	TRY(checkTransform(document, place, use));
	return use;
}

// A factor that the format bounds to [0, 1]; outside values are drawn as the nearest bound.
static float unitFactor(GltfDocument& document, const std::string& place, double value)
{
	if (value < 0 || value > 1)
		document.warnings.add(place, "is outside 0..1 and clamped");
	return static_cast<float>(std::clamp(value, 0.0, 1.0));
}

static Result<float> finiteFloat(const GltfDocument& document, const std::string& place, double value)
{
	const float result = static_cast<float>(value);
	if (!std::isfinite(result))
		return document.bad(place, "is {}, which is too large for a 32-bit float", value);
	return result;
}

static Status importDisplacement(GltfDocument& document, const std::string& material_place, const tinygltf::Material& source, Material& material)
{
	const auto found = source.extensions.find(kDisplacementExtension);
	if (found == source.extensions.end())
		return {};
	const Value& extension = found->second;
	const std::string place = fmt::format("{}.extensions.{}", material_place, kDisplacementExtension);
	if (!extension.Has("displacementGeometryTexture"))
	{
		document.warnings.add(place, "has no displacementGeometryTexture and is left out");
		return {};
	}
	Displacement displacement;
	const std::string texture_place = place + ".displacementGeometryTexture";
	TRY_ASSIGN(displacement.height, textureUse(document, texture_place, extension.Get("displacementGeometryTexture")));
	TRY_ASSIGN(displacement.factor,
			   finiteFloat(document, place + ".displacementGeometryFactor", numberOr(extension, "displacementGeometryFactor", 1)));
	TRY_ASSIGN(displacement.offset,
			   finiteFloat(document, place + ".displacementGeometryOffset", numberOr(extension, "displacementGeometryOffset", 0)));
	material.displacement = displacement;
	return {};
}

static void warnAboutLeftOut(GltfDocument& document, const std::string& place, const tinygltf::Material& source)
{
	const auto leaveOut = [&](bool asked, const char* name) {
		if (asked)
			document.warnings.add(place + "." + name, std::string(name) + " is not drawn");
	};
	leaveOut(source.normalTexture.index >= 0, "normalTexture");
	leaveOut(source.occlusionTexture.index >= 0, "occlusionTexture");
	leaveOut(source.emissiveTexture.index >= 0, "emissiveTexture");
	leaveOut(source.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0, "metallicRoughnessTexture");
	if (source.alphaMode == "MASK" || source.alphaMode == "BLEND")
		document.warnings.add(place + ".alphaMode", source.alphaMode + " is not supported and drawn opaque");
	else if (source.alphaMode != "OPAQUE")
		document.warnings.add(place + ".alphaMode", "is none of OPAQUE, MASK and BLEND and drawn opaque");
}

static Result<Material> importMaterial(GltfDocument& document, const std::string& place, const tinygltf::Material& source)
{
	Material material;
	material.name = source.name;
	material.double_sided = source.doubleSided;
	const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
	const std::string pbr_place = place + ".pbrMetallicRoughness";
	for (int i = 0; i < 4; ++i)
		material.base_color[i] = unitFactor(document, pbr_place + ".baseColorFactor", pbr.baseColorFactor[static_cast<size_t>(i)]);
	material.metallic = unitFactor(document, pbr_place + ".metallicFactor", pbr.metallicFactor);
	material.roughness = unitFactor(document, pbr_place + ".roughnessFactor", pbr.roughnessFactor);
	for (int i = 0; i < 3; ++i)
	{
		TRY_ASSIGN(material.emissive[i], finiteFloat(document, place + ".emissiveFactor", source.emissiveFactor[static_cast<size_t>(i)]));
	}
	if (pbr.baseColorTexture.index >= 0)
	{
		TRY_ASSIGN(material.base_color_texture, textureUse(document, pbr_place + ".baseColorTexture", pbr.baseColorTexture));
	}
	TRY(importDisplacement(document, place, source, material));
	warnAboutLeftOut(document, place, source);
	return material;
}

Result<std::vector<Material>> importMaterials(GltfDocument& document, const tinygltf::Model& model)
{
	std::vector<Material> materials;
	for (size_t i = 0; i < model.materials.size(); ++i)
	{
		TRY_ASSIGN(Material material, importMaterial(document, fmt::format("materials[{}]", i), model.materials[i]));
		materials.push_back(std::move(material));
	}
	return materials;
}

}  // namespace tessera
