// The one place that compiles tinygltf. Without its file system it forgets to include <fstream>.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "scene/gltf_model.h"

#include <algorithm>
#include <limits>

namespace tessera
{

static std::string oneLine(std::string text)
{
	while (!text.empty() && text.back() == '\n')
		text.pop_back();
	std::replace(text.begin(), text.end(), '\n', ';');
	return text;
}

Result<tinygltf::Model> parseGltfModel(const GltfDocument& document)
{
	Json description = document.json;
	for (const char* name : { "buffers", "images", "animations", "skins", "extensions", "extras" })
		description.erase(name);
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
