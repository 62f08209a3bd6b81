// What surrounds the geometry: nodes, instances, cameras, materials, textures, files.
#include "gltf_file.h"

#include <cmath>
#include <numbers>

namespace tessera
{

static std::vector<std::byte> bytesOf(const std::string& name)
{
	return readBytes(dataFile(name));
}

// Appends an image embedded in the buffer and a texture of it; returns the texture's index.
static size_t addTexture(GltfFile& file, const std::string& name)
{
	const std::vector<std::byte> bytes = bytesOf(name);
	const size_t view = file.addView(bytes.data(), bytes.size());
	file.json["images"].push_back({ { "bufferView", view }, { "mimeType", "image/png" } });
	file.json["textures"].push_back({ { "source", file.json["images"].size() - 1 } });
	return file.json["textures"].size() - 1;
}

static Json displacementBy(size_t texture)
{
	return { { "KHR_materials_displacement", { { "displacementGeometryTexture", { { "index", texture } } } } } };
}

TEST(gltfNodes, aHierarchyMultipliesNonUniformAndMirroredTransforms)
{
	IMPORTED(scene, importGltf(dataFile("hierarchy.gltf")));
	ASSERT_EQ(scene.instances.size(), 4u);
	const dmat4& world = scene.instances[0].world;
	EXPECT_EQ(world[0], dvec4(-1, 0, 0, 0));
	EXPECT_EQ(world[1], dvec4(0, 2, 0, 0));
	EXPECT_EQ(world[2], dvec4(0, 0, 0.5, 0));
	EXPECT_EQ(world[3], dvec4(1, 2, 3, 1));
	EXPECT_LT(glm::determinant(world), 0) << "the mirror stays in the matrix";
}

TEST(gltfNodes, gpuInstancingPlacesEveryCopyUnderItsNode)
{
	IMPORTED(scene, importGltf(dataFile("hierarchy.gltf")));
	// The node turns by 90 degrees around y after moving to (1, 2, 3): local +x becomes world -z.
	const auto transformed = [&](size_t instance, dvec3 point) {
		return dvec3(scene.instances[instance].world * dvec4(point, 1));
	};
	const auto expectNear = [](dvec3 a, dvec3 b) {
		EXPECT_LT(glm::length(a - b), 1e-6) << a.x << " " << a.y << " " << a.z;
	};
	expectNear(transformed(1, { 0, 0, 0 }), { 1, 2, 3 });
	expectNear(transformed(1, { 1, 0, 0 }), { 1, 2, 2 });
	expectNear(transformed(2, { 0, 0, 0 }), { 1, 2, 1 });
	expectNear(transformed(2, { 0, 1, 0 }), { 1, 0, 1 });  // turned by 180 degrees around z, scaled by 2 in y
	expectNear(transformed(2, { 0, 0, 1 }), { 4, 2, 1 });  // scaled by 3 in z
	EXPECT_LT(glm::determinant(scene.instances[3].world), 0);
	for (size_t i = 1; i < 4; ++i)
		EXPECT_EQ(scene.meshes[scene.instances[i].mesh].name, "bent");
}

TEST(gltfNodes, camerasKeepTheirProjectionAndPlace)
{
	IMPORTED(scene, importGltf(dataFile("hierarchy.gltf")));
	ASSERT_EQ(scene.cameras.size(), 2u);
	EXPECT_EQ(scene.cameras[0].name, "main");
	EXPECT_FALSE(scene.cameras[0].orthographic);
	EXPECT_DOUBLE_EQ(scene.cameras[0].fov_y_rad, 0.8);
	EXPECT_DOUBLE_EQ(scene.cameras[0].near_world, 0.1);
	EXPECT_EQ(scene.cameras[0].world[3], dvec4(0, 0, 5, 1));
	EXPECT_TRUE(scene.cameras[1].orthographic);
	EXPECT_DOUBLE_EQ(scene.cameras[1].height_world, 3.0);
}

TEST(gltfNodes, aChainOf100000NodesIsWalkedWithoutRecursion)
{
	GltfFile file = squareFile();
	Json nodes = Json::array();
	for (int i = 0; i < 100000; ++i)
		nodes.push_back({ { "children", { i + 1 } }, { "translation", { 1, 0, 0 } } });
	nodes.push_back({ { "mesh", 0 } });
	file.json["nodes"] = nodes;
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.instances[0].world[3], dvec4(100000, 0, 0, 1));
}

TEST(gltfNodes, cyclesAndSecondParentsAreRefused)
{
	GltfFile file = squareFile();
	file.json["nodes"] = { { { "mesh", 0 }, { "children", { 1 } } }, { { "children", { 0 } } } };
	expectRefused(file.import(), "nodes[0]: is reached twice");
	file.json["nodes"] = { { { "mesh", 0 }, { "children", { 1, 2 } } }, { { "children", { 2 } } }, Json::object() };
	expectRefused(file.import(), "nodes[2]: is reached twice");
	file.json["nodes"] = { { { "children", { 0 } } } };
	expectRefused(file.import(), "nodes[0]: is reached twice");
}

TEST(gltfNodes, withoutScenesAllRootsAreDrawnAndOnlyTheDefaultSceneOtherwise)
{
	GltfFile file = squareFile();
	file.json["nodes"] = { { { "mesh", 0 } }, { { "mesh", 0 }, { "children", { 2 } } }, { { "mesh", 0 } } };
	file.json.erase("scene");
	file.json["scenes"] = { { { "nodes", { 0 } } }, { { "nodes", { 1 } } } };
	IMPORTED(first, file.import());
	EXPECT_EQ(first.instances.size(), 1u);
	EXPECT_TRUE(hasWarning(first, "only scene 0 of 2 is drawn"));
	file.json["scene"] = 1;
	IMPORTED(second, file.import());
	EXPECT_EQ(second.instances.size(), 2u);
	file.json.erase("scene");
	file.json.erase("scenes");
	IMPORTED(roots, file.import());
	EXPECT_EQ(roots.instances.size(), 3u);
}

TEST(gltfNodes, singularMatricesAreKeptAndThoseThatAreNotFiniteRefused)
{
	GltfFile file = squareFile();
	file.json["nodes"][0]["scale"] = { 0, 1, 1 };
	IMPORTED(scene, file.import());
	EXPECT_EQ(glm::determinant(scene.instances[0].world), 0);
	file.json["nodes"] = { { { "scale", { 1e30, 1, 1 } }, { "children", { 1 } } }, { { "scale", { 1e30, 1, 1 } }, { "mesh", 0 } } };
	expectRefused(file.import(), "nodes[1]: its world matrix is not finite");
}

TEST(gltfNodes, rotationsAreMadeUnit)
{
	GltfFile file = squareFile();
	file.json["nodes"][0]["rotation"] = { 0, 0, 2, 2 };
	IMPORTED(scene, file.import());
	EXPECT_LT(glm::length(dvec3(scene.instances[0].world[0]) - dvec3(0, 1, 0)), 1e-12);
	file.json["nodes"][0]["rotation"] = { 0, 0, 0, 0 };
	expectRefused(file.import(), "nodes[0].rotation: has length 0");
}

TEST(gltfNodes, meshesThatNoNodeDrawsAreNotDecoded)
{
	GltfFile file = squareFile();
	const size_t broken = file.addFloats({ NAN, 0, 0, 1, 0, 0, 0, 1, 0 }, "VEC3");
	file.json["meshes"].push_back({ { "primitives", { { { "attributes", { { "POSITION", broken } } } } } } });
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes.size(), 1u);
}

TEST(gltfMaterials, factorsTextureSidednessAndSamplerArriveUnchanged)
{
	IMPORTED(scene, importGltf(dataFile("displaced_quad.glb")));
	const Material& material = scene.materials[0];
	EXPECT_EQ(material.name, "stone");
	EXPECT_EQ(material.base_color, vec4(0.5f, 0.25f, 1, 1));
	EXPECT_EQ(material.metallic, 0);
	EXPECT_EQ(material.roughness, 0.75f);
	EXPECT_TRUE(material.double_sided);
	ASSERT_TRUE(material.base_color_texture);
	const Texture& texture = scene.textures[material.base_color_texture->texture];
	EXPECT_EQ(texture.wrap_u, Wrap::ClampToEdge);
	EXPECT_EQ(texture.wrap_v, Wrap::MirroredRepeat);
	EXPECT_TRUE(texture.nearest);
	EXPECT_EQ(scene.images[texture.image].channels, 3u);
	EXPECT_EQ(scene.images[texture.image].format, TexelFormat::U8);
}

TEST(gltfMaterials, displacementCarriesFactorOffsetTransformAnd16BitTexels)
{
	IMPORTED(scene, importGltf(dataFile("displaced_quad.glb")));
	ASSERT_TRUE(scene.materials[0].displacement);
	const Displacement& displacement = *scene.materials[0].displacement;
	EXPECT_EQ(displacement.factor, 0.125f);
	EXPECT_EQ(displacement.offset, -0.0625f);
	EXPECT_DOUBLE_EQ(displacement.height.row0.z, 0.5);
	EXPECT_DOUBLE_EQ(displacement.height.row1.z, 0.25);
	const Texture& texture = scene.textures[displacement.height.texture];
	EXPECT_EQ(texture.wrap_u, Wrap::Repeat);
	EXPECT_EQ(scene.images[texture.image].format, TexelFormat::U16);
	EXPECT_EQ(scene.images[texture.image].channels, 1u);
}

TEST(gltfMaterials, displacementDefaultsAreFactorOneAndOffsetZero)
{
	GltfFile file = squareFile();
	file.json["materials"][0]["extensions"] = displacementBy(addTexture(file, "height8.png"));
	IMPORTED(scene, file.import());
	ASSERT_TRUE(scene.materials[0].displacement);
	EXPECT_EQ(scene.materials[0].displacement->factor, 1);
	EXPECT_EQ(scene.materials[0].displacement->offset, 0);
	EXPECT_EQ(scene.images[0].format, TexelFormat::U8);
}

TEST(gltfMaterials, primitivesKeepTheirOwnMaterialsAndThoseWithoutGetADefault)
{
	IMPORTED(scene, importGltf(dataFile("hierarchy.gltf")));
	EXPECT_EQ(scene.materials[scene.meshes[0].primitives[0].material].name, "rock");
	EXPECT_EQ(scene.materials[scene.meshes[0].primitives[1].material].name, "plain");
	EXPECT_EQ(scene.materials[scene.meshes[1].primitives[0].material].name, "default");
	EXPECT_EQ(scene.materials.size(), 3u);
}

// The extension's own sample: with rotation 22.5 degrees, the texel at 45 degrees is seen at 67.5 degrees.
TEST(gltfMaterials, textureTransformRotatesAsTheSampleModelShows)
{
	GltfFile file = squareFile();
	const size_t texture = addTexture(file, "color.png");
	file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {
		{ "index", texture }, { "extensions", { { "KHR_texture_transform", { { "rotation", std::numbers::pi / 8 } } } } }
	};
	IMPORTED(scene, file.import());
	const TextureUse& use = *scene.materials[0].base_color_texture;
	const double angle = 3 * std::numbers::pi / 8;
	const dvec3 uv(std::cos(angle), std::sin(angle), 1);
	EXPECT_NEAR(glm::dot(use.row0, uv), std::sqrt(0.5), 1e-12);
	EXPECT_NEAR(glm::dot(use.row1, uv), std::sqrt(0.5), 1e-12);
}

TEST(gltfMaterials, textureTransformScalesThenRotatesThenMovesAndMayChooseTheSet)
{
	GltfFile file = squareFile();
	const size_t texture = addTexture(file, "color.png");
	file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_3"] = 2;
	file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {
		{ "index", texture },
		{ "texCoord", 1 },
		{ "extensions",
		  { { "KHR_texture_transform",
			  { { "rotation", std::numbers::pi / 2 }, { "scale", { 2, 3 } }, { "offset", { 0.25, 0.5 } }, { "texCoord", 3 } } } } }
	};
	IMPORTED(scene, file.import());
	const TextureUse& use = *scene.materials[0].base_color_texture;
	EXPECT_EQ(use.texcoord, 3u);
	// (1, 1) scaled is (2, 3); a quarter turn takes (u, v) to (v, -u).
	EXPECT_NEAR(glm::dot(use.row0, dvec3(1, 1, 1)), 3.25, 1e-12);
	EXPECT_NEAR(glm::dot(use.row1, dvec3(1, 1, 1)), -1.5, 1e-12);
	EXPECT_EQ(scene.meshes[0].primitives[0].texcoords[3].size(), 4u);
}

TEST(gltfMaterials, aPrimitiveWithoutTheTexcoordsIsDrawnWithoutTextureAndDisplacementAndTheOthersKeepThem)
{
	GltfFile file = squareFile();
	const size_t texture = addTexture(file, "height8.png");
	file.json["materials"][0]["extensions"] = displacementBy(texture);
	file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = { { "index", texture } };
	file.addPrimitive({ { "POSITION", 0 } })["material"] = 0;
	IMPORTED(scene, file.import());
	const Material& whole = scene.materials[scene.meshes[0].primitives[0].material];
	const Material& bare = scene.materials[scene.meshes[0].primitives[1].material];
	EXPECT_TRUE(whole.displacement && whole.base_color_texture && !whole.variant_of);
	EXPECT_TRUE(!bare.displacement && !bare.base_color_texture);
	EXPECT_EQ(bare.variant_of, 0u);
	EXPECT_TRUE(hasWarning(scene, "meshes[0].primitives[1]: has no TEXCOORD_0: drawn without displacement"));
	EXPECT_TRUE(hasWarning(scene, "meshes[0].primitives[1]: has no TEXCOORD_0: drawn without its base colour texture"));
}

TEST(gltfMaterials, imagesThatNothingDrawnUsesAreNeverOpened)
{
	GltfFile file = squareFile();
	file.json["images"] = { { { "uri", "missing.png" } } };
	file.json["textures"] = { { { "source", 0 } } };
	file.json["materials"][0]["normalTexture"] = { { "index", 0 } };
	file.json["materials"].push_back({ { "pbrMetallicRoughness", { { "baseColorTexture", { { "index", 0 } } } } } });
	IMPORTED(scene, file.import());
	EXPECT_TRUE(scene.images.empty());
	EXPECT_TRUE(scene.textures.empty());
	EXPECT_TRUE(hasWarning(scene, "materials[0].normalTexture: normalTexture is not drawn"));
}

TEST(gltfMaterials, anImageUsedByTwoTexturesIsDecodedOnce)
{
	GltfFile file = squareFile();
	const size_t texture = addTexture(file, "color.png");
	file.json["textures"].push_back({ { "source", 0 } });
	file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = { { "index", texture } };
	file.json["materials"][0]["extensions"] = displacementBy(texture + 1);
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.textures.size(), 2u);
	EXPECT_EQ(scene.images.size(), 1u);
}

TEST(gltfMaterials, whatIsNotDrawnIsWarnedAboutByName)
{
	GltfFile file = squareFile();
	Json& material = file.json["materials"][0];
	material["alphaMode"] = "BLEND";
	material["extensions"] = { { "KHR_materials_clearcoat", Json::object() } };
	material["pbrMetallicRoughness"] = { { "baseColorFactor", { 2, 0, 0, 1 } } };
	file.json["extensionsUsed"] = { "KHR_materials_clearcoat", "KHR_lights_punctual" };
	file.json["animations"] = { Json::object() };
	file.json["skins"] = { Json::object() };
	file.json["nodes"][0]["skin"] = 0;
	file.json["meshes"][0]["primitives"][0]["targets"] = { { { "POSITION", 0 } } };
	IMPORTED(scene, file.import());
	EXPECT_TRUE(hasWarning(scene, "materials[0].alphaMode: BLEND is not supported and drawn opaque"));
	EXPECT_TRUE(hasWarning(scene, "materials[0].extensions: extension KHR_materials_clearcoat is not supported and left out"));
	EXPECT_TRUE(hasWarning(scene, "extensionsUsed: extension KHR_lights_punctual is not supported and left out"));
	EXPECT_TRUE(hasWarning(scene, "animations: 1 animation is not supported"));
	EXPECT_TRUE(hasWarning(scene, "nodes[0].skin: skins are not supported"));
	EXPECT_TRUE(hasWarning(scene, "meshes[0].primitives[0]: morph targets are not supported"));
	EXPECT_TRUE(hasWarning(scene, "baseColorFactor: is outside 0..1 and clamped"));
}

// A square with a base colour image at `uri`.
static GltfFile withImageUri(const std::string& uri)
{
	GltfFile file = squareFile();
	file.json["images"] = { { { "uri", uri } } };
	file.json["textures"] = { { { "source", 0 } } };
	file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = { { "index", 0 } };
	return file;
}

TEST(gltfFiles, percentEncodedNamesAndFoldersBelowAreFound)
{
	const TemporaryFolder folder;
	std::filesystem::create_directories(folder.path / "textures");
	writeBytes(folder.path / "textures" / "my \xc3\xa9 image.png", bytesOf("color.png"));
	IMPORTED(scene, importGltf(withImageUri("textures/my%20%C3%a9%20image.png").write(folder.path)));
	EXPECT_EQ(scene.images.size(), 1u);
	IMPORTED(roundabout, importGltf(withImageUri("./textures/../textures/my %C3%A9 image.png").write(folder.path)));
	EXPECT_EQ(roundabout.images.size(), 1u);
}

TEST(gltfFiles, urisThatLeaveTheFolderAreRefused)
{
	const TemporaryFolder folder;
	const std::filesystem::path inside = folder.path / "inside";
	std::filesystem::create_directories(inside);
	writeBytes(folder.path / "secret.png", bytesOf("color.png"));
	std::filesystem::create_symlink(folder.path / "secret.png", inside / "link.png");
	for (const std::string& uri :
		 { std::string("../secret.png"), std::string("%2e%2e/secret.png"), std::string("a/../../secret.png"), std::string("..%2Fsecret.png"),
		   (folder.path / "secret.png").string(), std::string("link.png"), std::string("file:///secret.png"), std::string("http://example.org/a.png"),
		   std::string("..\\secret.png"), std::string("a%00.png"), std::string("a%zz.png"), std::string() })
		expectRefused(importGltf(withImageUri(uri).write(inside)), "images[0].uri: ");
}

TEST(gltfFiles, missingFilesAreNamed)
{
	expectRefused(withImageUri("nowhere.png").import(), "images[0].uri: \"nowhere.png\" does not exist");
	expectRefused(importGltf("no such file.gltf"), "no such file.gltf: cannot be opened");
	const TemporaryFolder folder;
	expectRefused(importGltf(folder.path), "is a folder");
}

TEST(gltfFiles, dataUrisOfAnyMediaTypeAreDecoded)
{
	// A JPEG's type on a PNG: the bytes decide.
	const std::string png = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mOoBwAAgQCAvcQyYwAAAABJRU5ErkJggg==";
	for (const char* head : { "data:image/jpeg;base64,", "data:;base64,", "data:application/x-anything;base64," })
	{
		const Result<ImportedScene> scene = withImageUri(head + png).import();
		// The image need not be a valid PNG for the URI to be read; only the URI itself must not be what fails.
		EXPECT_TRUE(scene || scene.error().message.find(".uri") == std::string::npos) << scene.error().message;
	}
	expectRefused(withImageUri("data:image/png;base64,!!!!").import(), "is not valid base64");
	expectRefused(withImageUri("data:image/png").import(), "has no comma");
}

}  // namespace tessera
