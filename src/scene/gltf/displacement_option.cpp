#include "scene/displacement_option.h"

#include "scene/gltf/material_variants.h"
#include "scene/gltf/warnings.h"
#include "scene/image_decode.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

namespace tessera
{

namespace fs = std::filesystem;

struct DisplacementOption
{
	std::string image;
	float factor = 1;
	float offset = 0;
	std::string material;  // empty: all
};

// The longest head that ends at a colon or at the end and is a file; without one, all up to the first colon.
static std::string_view imagePart(std::string_view option)
{
	for (size_t end = option.size(); end != std::string_view::npos && end > 0; end = option.rfind(':', end - 1))
	{
		std::error_code code;
		if (fs::is_regular_file(fs::path(option.substr(0, end)), code))
			return option.substr(0, end);
	}
	return option.substr(0, option.find(':'));
}

static Result<float> parseNumber(std::string_view option, std::string_view text, const char* what, float otherwise)
{
	if (text.empty())
		return otherwise;
	float value = 0;
	const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
	if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
		return fail(ExitCode::Usage, "--displacement {}: {} \"{}\" is not a number; image[:factor[:offset[:material]]] is right", option, what, text);
	return value;
}

static Result<DisplacementOption> parseOption(std::string_view option)
{
	if (option.empty() || option.front() == ':')
		return fail(ExitCode::Usage, "--displacement {}: the image is missing; image[:factor[:offset[:material]]] is right", option);
	DisplacementOption parsed;
	parsed.image = imagePart(option);
	std::string_view rest = option.substr(parsed.image.size());
	const auto next = [&] {
		if (rest.empty())
			return std::string_view();
		rest.remove_prefix(1);
		const std::string_view part = rest.substr(0, rest.find(':'));
		rest.remove_prefix(part.size());
		return part;
	};
	TRY_ASSIGN(parsed.factor, parseNumber(option, next(), "factor", 1));
	TRY_ASSIGN(parsed.offset, parseNumber(option, next(), "offset", 0));
	parsed.material = rest.empty() ? "" : rest.substr(1);
	return parsed;
}

// Materials that `wanted` means, with the variants made from them.
static Result<std::vector<bool>> chooseMaterials(const ImportedScene& scene, std::string_view option, const std::string& wanted)
{
	std::vector<bool> chosen(scene.materials.size(), wanted.empty());
	for (size_t i = 0; i < scene.materials.size(); ++i)
		if (!wanted.empty() && scene.materials[i].name == wanted)
			chosen[i] = true;
	size_t index = 0;
	const auto [end, code] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
	const bool is_index = !wanted.empty() && code == std::errc() && end == wanted.data() + wanted.size();
	if (is_index && index < scene.materials.size() && std::find(chosen.begin(), chosen.end(), true) == chosen.end())
		chosen[index] = true;
	if (std::find(chosen.begin(), chosen.end(), true) == chosen.end())
		return badInput("--displacement {}: {} has no material \"{}\"; a name or an index from 0 to {} is right", option, scene.path, wanted,
						scene.materials.size() - 1);
	for (size_t i = 0; i < scene.materials.size(); ++i)
		if (scene.materials[i].variant_of && chosen[*scene.materials[i].variant_of])
			chosen[i] = true;
	return chosen;
}

Status attachDisplacement(ImportedScene& scene, std::string_view option)
{
	TRY_ASSIGN(const DisplacementOption parsed, parseOption(option));
	TRY_ASSIGN(const std::vector<bool> chosen, chooseMaterials(scene, option, parsed.material));
	std::vector<std::string> remarks;
	TRY_ASSIGN(Image image, readImage(parsed.image, remarks));
	for (const std::string& remark : remarks)
		scene.warnings.push_back(fmt::format("{}: {}", parsed.image, remark));

	Displacement displacement;
	displacement.height.texture = static_cast<uint32_t>(scene.textures.size());
	displacement.factor = parsed.factor;
	displacement.offset = parsed.offset;
	scene.textures.push_back({ .image = static_cast<uint32_t>(scene.images.size()) });
	scene.images.push_back(std::move(image));
	for (size_t i = 0; i < scene.materials.size(); ++i)
		if (chosen[i])
			scene.materials[i].displacement = displacement;

	GltfWarnings warnings;
	for (const LostTexture& lost : dropTexturesWithoutTexcoords(scene))
		warnings.add(fmt::format("mesh {} \"{}\", primitive {}", lost.mesh, scene.meshes[lost.mesh].name, lost.primitive), lost.text);
	for (const std::string& line : warnings.lines(scene.path))
		scene.warnings.push_back(line);
	dropUnusedTextures(scene);
	return {};
}

}  // namespace tessera
