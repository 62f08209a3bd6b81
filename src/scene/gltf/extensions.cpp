#include "scene/gltf/schema.h"

#include <algorithm>
#include <array>
#include <map>

namespace tessera
{

static constexpr std::array<std::string_view, 5> kSupported = {
	"EXT_mesh_gpu_instancing", "KHR_draco_mesh_compression", "KHR_materials_displacement", "KHR_mesh_quantization", "KHR_texture_transform",
};

static bool isSupported(const std::string& name)
{
	return std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
}

// Finds the first place of every extension object. The document's nesting is bounded, so recursion is too.
static void collectExtensions(const Json& value, const std::string& place, std::map<std::string, std::string>& first_place)
{
	if (value.is_array())
	{
		for (size_t i = 0; i < value.size(); ++i)
			if (value[i].is_structured())
				collectExtensions(value[i], fmt::format("{}[{}]", place, i), first_place);
		return;
	}
	for (auto it = value.begin(); it != value.end(); ++it)
	{
		if (!it.value().is_structured() || it.key() == "extras")
			continue;
		const std::string inner = place.empty() ? it.key() : place + "." + it.key();
		if (it.key() == "extensions" && it.value().is_object())
			for (auto extension = it.value().begin(); extension != it.value().end(); ++extension)
				first_place.try_emplace(extension.key(), inner);
		collectExtensions(it.value(), inner, first_place);
	}
}

Status checkGltfExtensions(GltfDocument& document)
{
	const Json& root = document.json;
	for (size_t i = 0; i < entryCount(root, "extensionsRequired"); ++i)
	{
		const std::string name = root["extensionsRequired"][i].get<std::string>();
		if (!isSupported(name))
			return document.bad(fmt::format("extensionsRequired[{}]", i), "{} is required, but not supported; supported are {}", name,
								fmt::join(kSupported, ", "));
	}

	std::map<std::string, std::string> first_place;
	collectExtensions(root, "", first_place);
	for (size_t i = 0; i < entryCount(root, "extensionsUsed"); ++i)
		first_place.try_emplace(root["extensionsUsed"][i].get<std::string>(), "extensionsUsed");
	for (const auto& [name, place] : first_place)
		if (!isSupported(name))
			document.warnings.add(place, fmt::format("extension {} is not supported and left out", name));
	return {};
}

}  // namespace tessera
