// Builds small glTF files for tests, right ones and wrong ones.
#pragma once
#include "base/result.h"
#include "scene/gltf_import.h"

#include <cstddef>
#include <filesystem>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tessera
{

using Json = nlohmann::json;

// A folder that goes away with the test.
class TemporaryFolder
{
public:
	TemporaryFolder();
	~TemporaryFolder();
	TemporaryFolder(const TemporaryFolder&) = delete;
	TemporaryFolder& operator=(const TemporaryFolder&) = delete;

	std::filesystem::path path;
};

// A description and its one buffer.
class GltfFile
{
public:
	// A scene with one node and one mesh, whose primitives are still missing.
	GltfFile();

	Json json;
	std::vector<std::byte> binary;

	size_t addView(const void* data, size_t bytes, size_t stride = 0);

	// An accessor over its own view. `type` is "SCALAR", "VEC2", ...
	template <typename T>
	size_t add(const std::vector<T>& values, const char* type, int component_type, bool normalized = false)
	{
		static const std::map<std::string, size_t> kComponents = { { "SCALAR", 1 }, { "VEC2", 2 }, { "VEC3", 3 }, { "VEC4", 4 } };
		const size_t view = addView(values.data(), values.size() * sizeof(T));
		Json accessor = {
			{ "bufferView", view }, { "componentType", component_type }, { "type", type }, { "count", values.size() / kComponents.at(type) }
		};
		if (normalized)
			accessor["normalized"] = true;
		json["accessors"].push_back(accessor);
		return json["accessors"].size() - 1;
	}
	size_t addFloats(const std::vector<float>& values, const char* type) { return add(values, type, 5126); }
	size_t addIndices(const std::vector<uint32_t>& values) { return add(values, "SCALAR", 5125); }

	// Appends a primitive to mesh 0.
	Json& addPrimitive(Json attributes, int mode = 4);

	// The description with its buffer embedded, written to `folder`.
	std::filesystem::path write(const std::filesystem::path& folder, const char* name = "file.gltf") const;
	std::filesystem::path writeGlb(const std::filesystem::path& folder) const;

	Result<ImportedScene> import() const;
	Result<ImportedScene> importGlb() const;
};

// A unit square of two triangles with POSITION, NORMAL, TEXCOORD_0, indices and material 0: accessors 0, 1, 2, 3.
GltfFile squareFile();

std::filesystem::path dataFile(const std::string& name);
void writeBytes(const std::filesystem::path& path, const std::vector<std::byte>& bytes);
std::vector<std::byte> readBytes(const std::filesystem::path& path);

// True when a warning contains `text`.
bool hasWarning(const ImportedScene& scene, const std::string& text);

// Fails the test unless `result` is a one-line BadInput error that contains `text`.
void expectRefused(const Result<ImportedScene>& result, const std::string& text);

// Checks every promise of imported_scene.h.
void expectPromisesKept(const ImportedScene& scene);

}  // namespace tessera

// Unwraps a Result or fails the test with its message.
#define IMPORTED(name, expression)                                              \
	const tessera::Result<tessera::ImportedScene> name##_result = (expression); \
	ASSERT_TRUE(name##_result) << name##_result.error().message;                \
	const tessera::ImportedScene& name = *name##_result;                        \
	tessera::expectPromisesKept(name)
