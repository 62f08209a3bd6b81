#include "gltf_file.h"

#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <unistd.h>

namespace tessera
{

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder()
{
	static std::atomic<int> next = 0;
	path = fs::temp_directory_path() / ("tessera_import_" + std::to_string(::getpid()) + "_" + std::to_string(next++));
	fs::create_directories(path);
}

TemporaryFolder::~TemporaryFolder()
{
	std::error_code code;
	fs::remove_all(path, code);
}

static std::string base64(const std::vector<std::byte>& bytes)
{
	const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	std::string text;
	for (size_t i = 0; i < bytes.size(); i += 3)
	{
		uint32_t bits = 0;
		for (size_t k = 0; k < 3; ++k)
			bits = bits << 8 | (i + k < bytes.size() ? std::to_integer<uint32_t>(bytes[i + k]) : 0u);
		for (size_t k = 0; k < 4; ++k)
			text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63u] : '=';
	}
	return text;
}

GltfFile::GltfFile()
{
	json = { { "asset", { { "version", "2.0" } } },
			 { "scene", 0 },
			 { "scenes", Json::array({ { { "nodes", { 0 } } } }) },
			 { "nodes", Json::array({ { { "mesh", 0 } } }) },
			 { "meshes", Json::array({ { { "primitives", Json::array() } } }) } };
}

size_t GltfFile::addView(const void* data, size_t bytes, size_t stride)
{
	binary.resize((binary.size() + 3) / 4 * 4);
	Json view = { { "buffer", 0 }, { "byteOffset", binary.size() }, { "byteLength", bytes } };
	if (stride != 0)
		view["byteStride"] = stride;
	json["bufferViews"].push_back(view);
	const std::byte* first = static_cast<const std::byte*>(data);
	binary.insert(binary.end(), first, first + bytes);
	return json["bufferViews"].size() - 1;
}

Json& GltfFile::addPrimitive(Json attributes, int mode)
{
	Json& primitives = json["meshes"][0]["primitives"];
	primitives.push_back({ { "attributes", std::move(attributes) }, { "mode", mode } });
	return primitives.back();
}

fs::path GltfFile::write(const fs::path& folder, const char* name) const
{
	Json complete = json;
	if (!binary.empty() && !complete.contains("buffers"))
		complete["buffers"] =
			Json::array({ { { "byteLength", binary.size() }, { "uri", "data:application/octet-stream;base64," + base64(binary) } } });
	std::ofstream(folder / name) << complete.dump();
	return folder / name;
}

fs::path GltfFile::writeGlb(const fs::path& folder) const
{
	Json complete = json;
	if (!complete.contains("buffers"))
		complete["buffers"] = Json::array({ { { "byteLength", binary.size() } } });
	std::string text = complete.dump();
	text.resize((text.size() + 3) / 4 * 4, ' ');
	std::vector<std::byte> padded = binary;
	padded.resize((binary.size() + 3) / 4 * 4);

	std::vector<std::byte> bytes;
	const auto put = [&](uint32_t value) {
		for (int i = 0; i < 4; ++i)
			bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
	};
	put(0x46546c67);
	put(2);
	put(static_cast<uint32_t>(12 + 8 + text.size() + 8 + padded.size()));
	put(static_cast<uint32_t>(text.size()));
	put(0x4e4f534a);
	const std::byte* first = reinterpret_cast<const std::byte*>(text.data());
	bytes.insert(bytes.end(), first, first + text.size());
	put(static_cast<uint32_t>(padded.size()));
	put(0x004e4942);
	bytes.insert(bytes.end(), padded.begin(), padded.end());
	writeBytes(folder / "file.glb", bytes);
	return folder / "file.glb";
}

Result<ImportedScene> GltfFile::import() const
{
	const TemporaryFolder folder;
	return importGltf(write(folder.path));
}

Result<ImportedScene> GltfFile::importGlb() const
{
	const TemporaryFolder folder;
	return importGltf(writeGlb(folder.path));
}

GltfFile squareFile()
{
	GltfFile file;
	const size_t positions = file.addFloats({ 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 }, "VEC3");
	const size_t normals = file.addFloats({ 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1 }, "VEC3");
	const size_t texcoords = file.addFloats({ 0, 1, 1, 1, 1, 0, 0, 0 }, "VEC2");
	const size_t indices = file.addIndices({ 0, 1, 2, 0, 2, 3 });
	Json& primitive = file.addPrimitive({ { "POSITION", positions }, { "NORMAL", normals }, { "TEXCOORD_0", texcoords } });
	primitive["indices"] = indices;
	primitive["material"] = 0;
	file.json["materials"] = Json::array({ { { "name", "paint" } } });
	return file;
}

fs::path dataFile(const std::string& name)
{
	return fs::path(TESSERA_TEST_DATA) / "gltf" / name;
}

void writeBytes(const fs::path& path, const std::vector<std::byte>& bytes)
{
	std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::vector<std::byte> readBytes(const fs::path& path)
{
	std::ifstream file(path, std::ios::binary);
	const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
	std::vector<std::byte> bytes(text.size());
	std::memcpy(bytes.data(), text.data(), text.size());
	return bytes;
}

bool hasWarning(const ImportedScene& scene, const std::string& text)
{
	for (const std::string& warning : scene.warnings)
		if (warning.find(text) != std::string::npos)
			return true;
	return false;
}

void expectRefused(const Result<ImportedScene>& result, const std::string& text)
{
	ASSERT_FALSE(result) << "was accepted, but should be refused with: " << text;
	EXPECT_EQ(result.error().code, ExitCode::BadInput);
	EXPECT_NE(result.error().message.find(text), std::string::npos) << result.error().message << "\nlacks: " << text;
	EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << "more than one line: " << result.error().message;
}

static void expectGoodFloat(float value)
{
	EXPECT_TRUE(std::isfinite(value));
	EXPECT_FALSE(value == 0 && std::signbit(value)) << "negative zero";
	EXPECT_TRUE(value == 0 || std::fabs(value) >= 0x1p-60f) << value;
}

static void expectPromisesKept(const ImportedScene& scene, const Primitive& primitive)
{
	const size_t count = primitive.positions.size();
	EXPECT_FALSE(primitive.indices.empty());
	EXPECT_EQ(primitive.indices.size() % 3, 0u);
	for (const uint32_t index : primitive.indices)
		ASSERT_LT(index, count);
	for (const vec3& position : primitive.positions)
		for (int c = 0; c < 3; ++c)
			expectGoodFloat(position[c]);
	EXPECT_TRUE(primitive.normals.empty() || primitive.normals.size() == count);
	for (const vec3& normal : primitive.normals)
		EXPECT_TRUE(normal == vec3(0) || std::fabs(glm::length(normal) - 1) < 1e-5f);
	EXPECT_TRUE(primitive.colors.empty() || primitive.colors.size() == count);
	for (const std::vector<vec2>& set : primitive.texcoords)
	{
		EXPECT_TRUE(set.empty() || set.size() == count);
		for (const vec2& coordinate : set)
			EXPECT_TRUE(std::isfinite(coordinate.x) && std::isfinite(coordinate.y));
	}

	ASSERT_LT(primitive.material, scene.materials.size());
	const Material& material = scene.materials[primitive.material];
	const auto hasSet = [&](const TextureUse& use) {
		return use.texcoord < primitive.texcoords.size() && !primitive.texcoords[use.texcoord].empty();
	};
	EXPECT_TRUE(!material.base_color_texture || hasSet(*material.base_color_texture));
	EXPECT_TRUE(!material.displacement || hasSet(material.displacement->height));
}

void expectPromisesKept(const ImportedScene& scene)
{
	EXPECT_FALSE(scene.materials.empty());
	EXPECT_FALSE(scene.instances.empty());
	for (const Mesh& mesh : scene.meshes)
	{
		EXPECT_FALSE(mesh.primitives.empty());
		for (const Primitive& primitive : mesh.primitives)
			expectPromisesKept(scene, primitive);
	}
	for (const Instance& instance : scene.instances)
	{
		EXPECT_LT(instance.mesh, scene.meshes.size());
		for (int c = 0; c < 4; ++c)
			for (int r = 0; r < 4; ++r)
				EXPECT_TRUE(std::isfinite(instance.world[c][r]));
	}
	for (const Material& material : scene.materials)
	{
		EXPECT_TRUE(!material.base_color_texture || material.base_color_texture->texture < scene.textures.size());
		EXPECT_TRUE(!material.displacement || material.displacement->height.texture < scene.textures.size());
	}
	for (const Texture& texture : scene.textures)
		EXPECT_LT(texture.image, scene.images.size());
	for (const Image& image : scene.images)
	{
		const size_t texel_size = image.format == TexelFormat::U8 ? 1 : image.format == TexelFormat::U16 ? 2 : 4;
		EXPECT_EQ(image.texels.size(), size_t(image.width) * image.height * image.channels * texel_size);
	}
	for (const std::string& warning : scene.warnings)
		EXPECT_EQ(warning.find('\n'), std::string::npos) << warning;
}

}  // namespace tessera
