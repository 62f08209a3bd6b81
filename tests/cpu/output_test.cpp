// Files that are written: read back they say the same; a failure leaves nothing behind.
#include "base/file.h"
#include "output/mesh_glb.h"
#include "output/png.h"
#include "scene/builtin.h"
#include "scene/gltf_import.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb_image.h>

#include <cstring>
#include <random>

namespace tessera
{
namespace
{

namespace fs = std::filesystem;

// A folder of its own for each test, gone afterwards.
class OutputTest : public testing::Test
{
protected:
	OutputTest()
	{
		const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
		folder_ = fs::temp_directory_path() / fmt::format("tessera_{}_{}", info->name(), std::random_device()());
		fs::create_directories(folder_);
	}
	~OutputTest() override { fs::remove_all(folder_); }

	fs::path at(const char* name) const { return folder_ / name; }
	size_t fileCount() const { return size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator())); }

	std::vector<std::byte> bytesOf(const fs::path& path) const
	{
		Result<std::vector<std::byte>> bytes = readFile(path);
		EXPECT_TRUE(bytes.has_value());
		return bytes ? std::move(*bytes) : std::vector<std::byte>();
	}

	fs::path folder_;
};
using Png = OutputTest;
using Ply = OutputTest;
using Glb = OutputTest;

// Smooth with some noise, so that every filter wins somewhere.
template <typename T>
std::vector<T> testTexels(uint32_t width, uint32_t height, uint32_t channels)
{
	std::minstd_rand random(width * 7 + height);
	std::vector<T> texels(size_t(width) * height * channels);
	for (size_t i = 0; i < texels.size(); ++i)
	{
		const size_t x = i / channels % width, y = i / channels / width;
		const uint64_t smooth = (x * 37 + y * y * 11 + i % channels * 5) * (sizeof(T) == 2 ? 61 : 1);
		texels[i] = T((y / 4) % 3 == 0 ? random() : smooth);
	}
	return texels;
}

TEST_F(Png, EightBitsDecodeToTheSameTexels)
{
	for (uint32_t channels = 1; channels <= 4; ++channels)
		for (const auto& [width, height] : { std::pair(1u, 1u), std::pair(1u, 9u), std::pair(37u, 21u), std::pair(640u, 3u) })
		{
			const std::vector<uint8_t> texels = testTexels<uint8_t>(width, height, channels);
			ASSERT_TRUE(writePng(at("a.png"), width, height, texels, channels));
			const std::vector<std::byte> file = bytesOf(at("a.png"));
			int w = 0, h = 0, c = 0;
			stbi_uc* decoded = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(file.data()), int(file.size()), &w, &h, &c, 0);
			ASSERT_NE(decoded, nullptr) << stbi_failure_reason();
			EXPECT_EQ(std::tuple(w, h, c), std::tuple(int(width), int(height), int(channels)));
			EXPECT_EQ(std::memcmp(decoded, texels.data(), texels.size()), 0);
			stbi_image_free(decoded);
		}
	EXPECT_EQ(fileCount(), 1u);
}

TEST_F(Png, SixteenBitsDecodeToTheSameTexels)
{
	for (uint32_t channels = 1; channels <= 4; ++channels)
	{
		const std::vector<uint16_t> texels = testTexels<uint16_t>(61, 44, channels);
		ASSERT_TRUE(writePng16(at("a.png"), 61, 44, texels, channels));
		const std::vector<std::byte> file = bytesOf(at("a.png"));
		const auto* data = reinterpret_cast<const stbi_uc*>(file.data());
		ASSERT_TRUE(stbi_is_16_bit_from_memory(data, int(file.size())));
		int w = 0, h = 0, c = 0;
		stbi_us* decoded = stbi_load_16_from_memory(data, int(file.size()), &w, &h, &c, 0);
		ASSERT_NE(decoded, nullptr) << stbi_failure_reason();
		EXPECT_EQ(std::tuple(w, h, c), std::tuple(61, 44, int(channels)));
		EXPECT_EQ(std::memcmp(decoded, texels.data(), texels.size() * 2), 0);
		stbi_image_free(decoded);
	}
}

TEST_F(Png, SmoothTexelsAreSmallerThanTheirBytes)
{
	std::vector<uint16_t> ramp(512 * 512);
	for (size_t i = 0; i < ramp.size(); ++i)
		ramp[i] = uint16_t(i % 512 * 100 + i / 512 * 27);
	ASSERT_TRUE(writePng16(at("a.png"), 512, 512, ramp));
	EXPECT_LT(fs::file_size(at("a.png")), ramp.size() * 2 / 20);
}

TEST_F(Png, FailureLeavesNoFile)
{
	const std::vector<uint8_t> texels(12);
	fs::create_directories(at("folder.png") / "inside");
	const Status onto_folder = writePng(at("folder.png"), 2, 2, texels, 3);
	ASSERT_FALSE(onto_folder);
	EXPECT_NE(onto_folder.error().message.find("folder.png"), std::string::npos);
	EXPECT_EQ(fileCount(), 1u);

	ASSERT_TRUE(writeFile(at("file"), std::string_view("text")));
	EXPECT_FALSE(writePng(at("file") / "a.png", 2, 2, texels, 3));
	EXPECT_FALSE(writePly(at("file") / "a.ply", {}));
	EXPECT_EQ(fileCount(), 2u);
}

// --- plain meshes --------------------------------------------------------------------------------------------------------------------

const std::vector<vec3> kPositions = { { 0, 0, 0 }, { 1.5f, 0, 0 }, { 1.5f, 2, 0.1f }, { 0, 2, -0.25f } };
const std::vector<vec3> kNormals(4, vec3(0, 0, 1));
const std::vector<vec2> kUvs = { { 0, 1 }, { 1, 1 }, { 1, 0 }, { 0, 0.25f } };
const std::vector<uint32_t> kIndices = { 0, 1, 2, 0, 2, 3 };

TEST_F(Ply, HoldsEveryVertexAndTriangle)
{
	ASSERT_TRUE(writePly(at("a.ply"), { kPositions, kNormals, kUvs, kIndices }));
	const std::vector<std::byte> file = bytesOf(at("a.ply"));
	const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
	const size_t body = text.find("end_header\n") + 11;
	EXPECT_TRUE(text.starts_with("ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"));
	EXPECT_NE(text.find("element face 2\nproperty list uchar uint vertex_indices\nend_header\n"), std::string_view::npos);
	ASSERT_EQ(file.size(), body + 4 * 32 + 2 * 13);

	float vertex[8];
	std::memcpy(vertex, &file[body + 3 * 32], sizeof(vertex));
	EXPECT_EQ(vec3(vertex[0], vertex[1], vertex[2]), kPositions[3]);
	EXPECT_EQ(vec3(vertex[3], vertex[4], vertex[5]), kNormals[3]);
	EXPECT_EQ(vec2(vertex[6], vertex[7]), vec2(0, 0.75f));
	uint32_t corners[3];
	EXPECT_EQ(file[body + 4 * 32 + 13], std::byte(3));
	std::memcpy(corners, &file[body + 4 * 32 + 14], sizeof(corners));
	EXPECT_EQ(corners[0], 0u);
	EXPECT_EQ(corners[1], 2u);
	EXPECT_EQ(corners[2], 3u);
}

TEST_F(Ply, LeavesOutWhatIsNotThere)
{
	ASSERT_TRUE(writePly(at("a.ply"), { kPositions, {}, {}, kIndices }));
	const std::vector<std::byte> file = bytesOf(at("a.ply"));
	const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
	EXPECT_EQ(text.find("nx"), std::string_view::npos);
	EXPECT_EQ(file.size(), text.find("end_header\n") + 11 + 4 * 12 + 2 * 13);
}

TEST_F(Glb, PlainMeshComesBack)
{
	ASSERT_TRUE(writeMeshGlb(at("a.glb"), { kPositions, kNormals, {}, kIndices }));
	const Result<ImportedScene> back = importGltf(at("a.glb"));
	ASSERT_TRUE(back) << back.error().message;
	ASSERT_EQ(back->meshes.size(), 1u);
	const Primitive& primitive = back->meshes[0].primitives.at(0);
	EXPECT_EQ(primitive.positions, kPositions);
	EXPECT_EQ(primitive.normals, kNormals);
	EXPECT_EQ(primitive.indices, kIndices);
}

// --- whole scenes --------------------------------------------------------------------------------------------------------------------

void expectSameTexture(const ImportedScene& a, const TextureUse& use_a, const ImportedScene& b, const TextureUse& use_b)
{
	EXPECT_EQ(use_a.texcoord, use_b.texcoord);
	EXPECT_EQ(use_a.row0, use_b.row0);
	EXPECT_EQ(use_a.row1, use_b.row1);
	const Texture &texture_a = a.textures.at(use_a.texture), &texture_b = b.textures.at(use_b.texture);
	EXPECT_EQ(texture_a.wrap_u, texture_b.wrap_u);
	EXPECT_EQ(texture_a.wrap_v, texture_b.wrap_v);
	EXPECT_EQ(texture_a.nearest, texture_b.nearest);
	const Image &image_a = a.images.at(texture_a.image), &image_b = b.images.at(texture_b.image);
	EXPECT_EQ(std::tuple(image_a.width, image_a.height, image_a.channels, image_a.format),
			  std::tuple(image_b.width, image_b.height, image_b.channels, image_b.format));
	EXPECT_TRUE(image_a.texels == image_b.texels) << image_a.name;
}

void expectSameMaterial(const ImportedScene& a, const Material& from, const ImportedScene& b, const Material& to)
{
	EXPECT_EQ(from.name, to.name);
	EXPECT_EQ(from.base_color, to.base_color);
	EXPECT_EQ(from.metallic, to.metallic);
	EXPECT_EQ(from.roughness, to.roughness);
	EXPECT_EQ(from.emissive, to.emissive);
	EXPECT_EQ(from.double_sided, to.double_sided);
	ASSERT_EQ(from.base_color_texture.has_value(), to.base_color_texture.has_value());
	if (from.base_color_texture)
		expectSameTexture(a, *from.base_color_texture, b, *to.base_color_texture);
	ASSERT_EQ(from.displacement.has_value(), to.displacement.has_value());
	if (!from.displacement)
		return;
	expectSameTexture(a, from.displacement->height, b, to.displacement->height);
	EXPECT_EQ(from.displacement->factor, to.displacement->factor);
	EXPECT_EQ(from.displacement->offset, to.displacement->offset);
}

void expectSamePrimitive(const Primitive& a, const Primitive& b)
{
	EXPECT_TRUE(a.positions == b.positions);
	EXPECT_TRUE(a.normals == b.normals);
	EXPECT_TRUE(a.texcoords == b.texcoords);
	EXPECT_TRUE(a.colors == b.colors);
	EXPECT_TRUE(a.indices == b.indices);
	EXPECT_EQ(a.material, b.material);
}

void expectSameScene(const ImportedScene& a, const ImportedScene& b)
{
	ASSERT_EQ(a.materials.size(), b.materials.size());
	for (size_t i = 0; i < a.materials.size(); ++i)
		expectSameMaterial(a, a.materials[i], b, b.materials[i]);
	ASSERT_EQ(a.meshes.size(), b.meshes.size());
	for (size_t i = 0; i < a.meshes.size(); ++i)
	{
		EXPECT_EQ(a.meshes[i].name, b.meshes[i].name);
		ASSERT_EQ(a.meshes[i].primitives.size(), b.meshes[i].primitives.size());
		for (size_t j = 0; j < a.meshes[i].primitives.size(); ++j)
			expectSamePrimitive(a.meshes[i].primitives[j], b.meshes[i].primitives[j]);
	}
	ASSERT_EQ(a.instances.size(), b.instances.size());
	for (size_t i = 0; i < a.instances.size(); ++i)
	{
		EXPECT_EQ(a.instances[i].mesh, b.instances[i].mesh);
		EXPECT_EQ(a.instances[i].world, b.instances[i].world);
	}
	ASSERT_EQ(a.cameras.size(), b.cameras.size());
	for (size_t i = 0; i < a.cameras.size(); ++i)
	{
		EXPECT_EQ(a.cameras[i].world, b.cameras[i].world);
		EXPECT_EQ(a.cameras[i].orthographic, b.cameras[i].orthographic);
		EXPECT_EQ(a.cameras[i].fov_y_rad, b.cameras[i].fov_y_rad);
		EXPECT_EQ(a.cameras[i].height_world, b.cameras[i].height_world);
		EXPECT_EQ(a.cameras[i].near_world, b.cameras[i].near_world);
	}
	EXPECT_TRUE(b.warnings.empty()) << b.warnings.front();
}

TEST_F(Glb, BuiltinScenesComeBackTheSame)
{
	for (const std::string_view name : { "quad", "cube", "materials", "instances:9", "planet" })
	{
		SCOPED_TRACE(name);
		const Result<ImportedScene> scene = makeBuiltinScene(name);
		ASSERT_TRUE(scene);
		const Status written = writeSceneGlb(at("a.glb"), *scene);
		ASSERT_TRUE(written) << written.error().message;
		const Result<ImportedScene> back = importGltf(at("a.glb"));
		ASSERT_TRUE(back) << back.error().message;
		expectSameScene(*scene, *back);
	}
	EXPECT_EQ(fileCount(), 1u);
}

// A scene that uses what the built-in ones do not.
ImportedScene oddScene()
{
	ImportedScene scene = *makeBuiltinScene("quad");
	Material& material = scene.materials[0];
	material.base_color = { 0.1f, 0.2f, 0.3f, 1 };
	material.emissive = { 0, 0.5f, 0.7f };
	material.double_sided = true;
	material.base_color_texture->row0 = { 2, 0, 0.25 };
	material.base_color_texture->row1 = { 0, -0.5, 0.125 };
	material.displacement->height.texcoord = 1;
	scene.textures[0].wrap_u = Wrap::MirroredRepeat;
	scene.textures[0].nearest = true;
	Primitive& quad = scene.meshes[0].primitives[0];
	quad.texcoords.push_back({ { 0.1f, 0.2f }, { 3, 4 }, { -5, 6 }, { 0.3f, 0.4f } });
	quad.colors.assign(4, vec4(0.25f, 0.5f, 1, 0.75f));
	FileCamera flat;
	flat.name = "flat";
	flat.orthographic = true;
	flat.height_world = 3;
	flat.near_world = 0.5;
	flat.fov_y_rad = FileCamera().fov_y_rad;
	scene.cameras.push_back(flat);
	return scene;
}

TEST_F(Glb, EveryFieldComesBack)
{
	const ImportedScene scene = oddScene();
	ASSERT_TRUE(writeSceneGlb(at("a.glb"), scene));
	const Result<ImportedScene> back = importGltf(at("a.glb"));
	ASSERT_TRUE(back) << back.error().message;
	expectSameScene(scene, *back);
}

TEST_F(Glb, TurnedTextureTransformComesBackNearly)
{
	ImportedScene scene = *makeBuiltinScene("quad");
	TextureUse& height = scene.materials[0].displacement->height;
	const double s = 0.6, c = 0.8;
	height.row0 = { c * 2, s * 3, 0.5 };
	height.row1 = { -s * 2, c * 3, -0.5 };
	ASSERT_TRUE(writeSceneGlb(at("a.glb"), scene));
	const Result<ImportedScene> back = importGltf(at("a.glb"));
	ASSERT_TRUE(back) << back.error().message;
	const TextureUse& returned = back->materials[0].displacement->height;
	EXPECT_LT(glm::length(returned.row0 - height.row0), 1e-12);
	EXPECT_LT(glm::length(returned.row1 - height.row1), 1e-12);
}

TEST_F(Glb, WhatTheFormatCannotSayIsRefused)
{
	ImportedScene sheared = *makeBuiltinScene("quad");
	sheared.materials[0].displacement->height.row0 = { 1, 0.5, 0 };
	const Status status = writeSceneGlb(at("a.glb"), sheared);
	ASSERT_FALSE(status);
	EXPECT_NE(status.error().message.find("a.glb"), std::string::npos);
	EXPECT_EQ(fileCount(), 0u);
}

TEST_F(Glb, FloatTexelsComeBackAsTheyWere)
{
	for (const uint32_t channels : { 1u, 2u, 3u, 4u })
	{
		ImportedScene scene = *makeBuiltinScene("quad");
		Image& image = scene.images[1];
		image = { "floats", 5, 3, channels, TexelFormat::F32, std::vector<std::byte>(size_t(5) * 3 * channels * 4) };
		for (uint32_t i = 0; i < 15 * channels; ++i)
		{
			const float value = 1e-7f * float(i * i) - 3.5f * float(i);
			std::memcpy(&image.texels[size_t(i) * 4], &value, 4);
		}
		ASSERT_TRUE(writeSceneGlb(at("a.glb"), scene));
		const Result<ImportedScene> back = importGltf(at("a.glb"));
		ASSERT_TRUE(back) << back.error().message;
		EXPECT_EQ(back->images[1].channels, channels);
		EXPECT_EQ(back->images[1].texels, image.texels) << channels << " channels";
	}
}

TEST_F(Glb, NamesOnlyTheExtensionsItUses)
{
	const auto extensions = [&](const ImportedScene& scene) {
		EXPECT_TRUE(writeSceneGlb(at("a.glb"), scene));
		const std::vector<std::byte> file = bytesOf(at("a.glb"));
		uint32_t length = 0;
		std::memcpy(&length, &file[12], 4);
		const auto* text = reinterpret_cast<const char*>(&file[20]);
		return nlohmann::json::parse(text, text + length)["extensionsUsed"].get<std::vector<std::string>>();
	};
	EXPECT_EQ(extensions(*makeBuiltinScene("quad")), std::vector<std::string>{ "KHR_materials_displacement" });
	EXPECT_EQ(extensions(oddScene()), (std::vector<std::string>{ "KHR_materials_displacement", "KHR_texture_transform" }));
}

}  // namespace
}  // namespace tessera
