// The one place that compiles tinygltf. Without its file system it forgets to include <fstream>.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "scene/gltf/model.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tessera
{

// tinygltf needs a view behind every index accessor and gives no place when one is missing.
static Status checkIndexViews(const GltfDocument& document)
{
	const size_t mesh_count = entryCount(document.json, "meshes");
	for (size_t i = 0; i < mesh_count; ++i)
	{
		const Json& primitives = document.json["meshes"][i]["primitives"];
		for (size_t j = 0; j < primitives.size(); ++j)
		{
			const auto indices = primitives[j].find("indices");
			if (indices != primitives[j].end() && !document.json["accessors"][indices->get<size_t>()].contains("bufferView"))
				return document.bad(fmt::format("meshes[{}].primitives[{}].indices", i, j), "accessors[{}] has no bufferView, but indices need one",
									indices->get<size_t>());
		}
	}
	return {};
}

Result<tinygltf::Model> parseGltfModel(const GltfDocument& document)
{
	TRY(checkIndexViews(document));
	constexpr std::array<std::string_view, 6> kHidden = { "buffers", "images", "animations", "skins", "extensions", "extras" };
	Json description = Json::object();
	for (auto it = document.json.begin(); it != document.json.end(); ++it)
		if (std::find(kHidden.begin(), kHidden.end(), it.key()) == kHidden.end())
			description[it.key()] = it.value();
	const std::string text = description.dump();
	if (text.size() > std::numeric_limits<unsigned>::max())
		return document.bad("JSON", "has {} bytes, more than can be read", text.size());

	tinygltf::TinyGLTF parser;
	tinygltf::Model model;
	std::string error;
	std::string warning;
	bool parsed = false;
	try
	{
		parsed = parser.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), "");
	}
	catch (const std::exception& exception)
	{
		error = exception.what();
	}
	if (!parsed)
		return document.bad("JSON", "{}", error.empty() ? "is not a glTF description" : oneLine(error));
	return model;
}

}  // namespace tessera
