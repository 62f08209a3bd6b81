// Broken files: each is refused with one line that names the file, the place, and what would be right.
#include "gltf_file.h"

#include <cstring>

namespace tessera
{

struct BrokenField
{
	const char* name;
	const char* pointer;  // JSON pointer into a square with a sparse accessor (4) and an image texture
	Json value;
	const char* message;
};

static void PrintTo(const BrokenField& field, std::ostream* out)
{
	*out << field.pointer << " = " << field.value.dump();
}

class gltfBrokenField : public testing::TestWithParam<BrokenField>
{
};

// Everything a file can point with, once.
static GltfFile fullFile()
{
	GltfFile file = squareFile();
	const uint16_t sparse_index = 2;
	const float sparse_value[3] = { 1, 1, 1 };
	const size_t index_view = file.addView(&sparse_index, sizeof(sparse_index));
	const size_t value_view = file.addView(sparse_value, sizeof(sparse_value));
	file.json["accessors"].push_back(file.json["accessors"][0]);
	file.json["accessors"][4]["sparse"] = { { "count", 1 },
											{ "indices", { { "bufferView", index_view }, { "componentType", 5123 } } },
											{ "values", { { "bufferView", value_view } } } };
	file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 4;
	const std::vector<std::byte> image = readBytes(dataFile("color.png"));
	const size_t image_view = file.addView(image.data(), image.size());
	file.json["images"] = { { { "bufferView", image_view }, { "mimeType", "image/png" } } };
	file.json["samplers"] = { { { "wrapS", 10497 } } };
	file.json["textures"] = { { { "source", 0 }, { "sampler", 0 } } };
	file.json["materials"][0] = {
		{ "pbrMetallicRoughness", { { "baseColorTexture", { { "index", 0 } } } } },
		{ "extensions",
		  { { "KHR_materials_displacement", { { "displacementGeometryTexture", { { "index", 0 } } }, { "displacementGeometryFactor", 1 } } } } }
	};
	file.json["cameras"] = { { { "type", "perspective" }, { "perspective", { { "yfov", 1 }, { "znear", 0.1 } } } } };
	file.json["nodes"].push_back({ { "camera", 0 } });
	file.json["scenes"][0]["nodes"] = { 0, 1 };
	file.json["buffers"] = { { { "byteLength", file.binary.size() } } };
	return file;
}

TEST(gltfRefusals, theFileThatTheOthersBreakIsAccepted)
{
	IMPORTED(scene, fullFile().importGlb());
	EXPECT_TRUE(scene.warnings.empty());
}

TEST_P(gltfBrokenField, isRefusedWithItsPlace)
{
	GltfFile file = fullFile();
	Json& field = file.json[Json::json_pointer(GetParam().pointer)];
	field = GetParam().value;
	expectRefused(file.importGlb(), GetParam().message);
}

static constexpr int64_t kHuge = int64_t(1) << 62;

INSTANTIATE_TEST_SUITE_P(
	fields, gltfBrokenField,
	testing::Values(
		BrokenField{ "version", "/asset/version", "1.0", "asset.version: is \"1.0\"" },
		BrokenField{ "minVersion", "/asset/minVersion", "2.1", "asset.minVersion: is \"2.1\"" },
		BrokenField{ "noAsset", "/asset", nullptr, "asset: is of type null, but an object is right" },
		BrokenField{ "scene", "/scene", 1, "scene: is 1, but the file has 1 scenes" },
		BrokenField{ "sceneNode", "/scenes/0/nodes/0", 9, "scenes[0].nodes[0]: is 9, but the file has 2 nodes: an index from 0 to 1 is right" },
		BrokenField{ "nodeMesh", "/nodes/0/mesh", -1, "nodes[0].mesh: is -1" },
		BrokenField{ "nodeCamera", "/nodes/1/camera", 7, "nodes[1].camera: is 7" },
		BrokenField{ "nodeSkin", "/nodes/0/skin", 0, "nodes[0].skin: is 0, but the file has no skins" },
		BrokenField{ "nodeMatrixLength", "/nodes/0/matrix", Json::array({ 1, 2, 3 }), "nodes[0].matrix: has 3 entries, but 16 are right" },
		BrokenField{ "nodeMatrixProjective", "/nodes/0/matrix", Json::array({ 1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 }),
					 "(affine) is right" },
		BrokenField{ "nodeScaleText", "/nodes/0/scale", Json::array({ 1, "2", 3 }), "nodes[0].scale[1]: is of type string, but a number is right" },
		BrokenField{ "instancing",
					 "/nodes/0/extensions",
					 { { "EXT_mesh_gpu_instancing", { { "attributes", { { "TRANSLATION", 2 } } } } } },
					 "attributes.TRANSLATION: is VEC2 of FLOAT, but VEC3 of FLOAT is right" },
		BrokenField{ "instancingNothing",
					 "/nodes/0/extensions",
					 { { "EXT_mesh_gpu_instancing", { { "attributes", Json::object() } } } },
					 "has none of TRANSLATION, ROTATION and SCALE" },
		BrokenField{ "attribute", "/meshes/0/primitives/0/attributes/NORMAL", 99, "meshes[0].primitives[0].attributes.NORMAL: is 99" },
		BrokenField{ "attributeType", "/meshes/0/primitives/0/attributes/POSITION", 2,
					 "attributes.POSITION: accessors[2] is VEC2 of FLOAT, but VEC3" },
		BrokenField{ "attributeInteger", "/accessors/1/componentType", 5125, "attributes.NORMAL: accessors[1] is VEC3 of UNSIGNED_INT" },
		BrokenField{ "attributeLength", "/accessors/2/count", 3, "attributes.TEXCOORD_0: accessors[2] has 3 elements, but POSITION has 4" },
		BrokenField{ "indices", "/meshes/0/primitives/0/indices", -5, "meshes[0].primitives[0].indices: is -5" },
		BrokenField{ "indicesFloat", "/accessors/3/componentType", 5126, "indices: accessors[3] is SCALAR of FLOAT" },
		BrokenField{ "indicesVector", "/meshes/0/primitives/0/indices", 1, "indices: accessors[1] is VEC3 of FLOAT, but SCALAR" },
		BrokenField{ "material", "/meshes/0/primitives/0/material", 1, "meshes[0].primitives[0].material: is 1" },
		BrokenField{ "mode", "/meshes/0/primitives/0/mode", 7, "meshes[0].primitives[0].mode: is 7, but an integer from 0 to 6 is right" },
		BrokenField{ "noPrimitives", "/meshes/0", Json::object(), "meshes[0].primitives: is missing" },
		BrokenField{ "accessorView", "/accessors/0/bufferView", 50, "accessors[0].bufferView: is 50" },
		BrokenField{ "accessorCountHuge", "/accessors/0/count", kHuge, "accessors[0].count: is 4611686018427387904" },
		BrokenField{ "accessorCountLarge", "/accessors/0/count", 0x7fffffff, "accessors[0]: 2147483647 elements of 12 bytes" },
		BrokenField{ "accessorCountZero", "/accessors/0/count", 0, "accessors[0].count: is 0" },
		BrokenField{ "accessorCountNegative", "/accessors/0/count", -4, "accessors[0].count: is -4" },
		BrokenField{ "accessorCountFraction", "/accessors/0/count", 4.5, "accessors[0].count: is of type number, but an integer is right" },
		BrokenField{ "accessorOffset", "/accessors/0/byteOffset", 4, "accessors[0]: 4 elements of 12 bytes, 12 bytes apart, from byteOffset 4" },
		BrokenField{ "accessorOffsetHuge", "/accessors/0/byteOffset", kHuge, "accessors[0].byteOffset: is 4611686018427387904" },
		BrokenField{ "accessorType", "/accessors/0/type", "VEC5", "accessors[0].type: is \"VEC5\", but SCALAR" },
		BrokenField{ "accessorComponent", "/accessors/0/componentType", 5124, "accessors[0].componentType: is 5124" },
		BrokenField{ "accessorWithoutView",
					 "/accessors/0",
					 { { "componentType", 5126 }, { "type", "VEC3" }, { "count", 1 << 30 } },
					 "accessors[0].count: is 1073741824, but an accessor without bufferView" },
		BrokenField{ "viewBuffer", "/bufferViews/0/buffer", 1, "bufferViews[0].buffer: is 1" },
		BrokenField{ "viewLength", "/bufferViews/0/byteLength", 1 << 20, "bufferViews[0]: byteOffset 0 and byteLength 1048576 reach beyond" },
		BrokenField{ "viewLengthHuge", "/bufferViews/0/byteLength", kHuge, "bufferViews[0].byteLength: is 4611686018427387904" },
		BrokenField{ "viewOffset", "/bufferViews/0/byteOffset", 1 << 20, "bufferViews[0]: byteOffset 1048576" },
		BrokenField{ "viewOffsetWraps", "/bufferViews/0/byteOffset", (uint64_t(1) << 53) - 1, "bufferViews[0]: byteOffset 9007199254740991" },
		BrokenField{ "viewStrideNegative", "/bufferViews/0/byteStride", -12, "bufferViews[0].byteStride: is -12" },
		BrokenField{ "viewStrideOdd", "/bufferViews/0/byteStride", 13, "bufferViews[0].byteStride: is 13, but a multiple of 4" },
		BrokenField{ "viewStrideSmall", "/bufferViews/0/byteStride", 8, "byteStride of bufferViews[0] is 8, but one element has 12 bytes" },
		BrokenField{ "viewStrideLarge", "/bufferViews/0/byteStride", 256, "bufferViews[0].byteStride: is 256" },
		BrokenField{ "sparseCount", "/accessors/4/sparse/count", 5, "accessors[4].sparse.count: is 5, but the accessor has only 4 elements" },
		BrokenField{ "sparseView", "/accessors/4/sparse/indices/bufferView", 77, "accessors[4].sparse.indices.bufferView: is 77" },
		BrokenField{ "sparseIndexType", "/accessors/4/sparse/indices/componentType", 5126, "accessors[4].sparse.indices.componentType: is 5126" },
		BrokenField{ "sparseIndexOffset", "/accessors/4/sparse/indices/byteOffset", 2, "accessors[4].sparse.indices: 1 indices of 2 bytes reach" },
		BrokenField{ "sparseValueOffset", "/accessors/4/sparse/values/byteOffset", 0x7fffffff, "accessors[4].sparse.values: 1 values of 12 bytes" },
		BrokenField{ "bufferLength", "/buffers/0/byteLength", 1 << 20, "buffers[0].byteLength: is 1048576, but its data has" },
		BrokenField{ "bufferUri", "/buffers/0/uri", "gone.bin", "buffers[0].uri: \"gone.bin\" does not exist" },
		BrokenField{ "textureIndex", "/materials/0/pbrMetallicRoughness/baseColorTexture/index", 3, "baseColorTexture.index: is 3" },
		BrokenField{ "textureSource", "/textures/0/source", 1, "textures[0].source: is 1" },
		BrokenField{ "textureSampler", "/textures/0/sampler", 1, "textures[0].sampler: is 1" },
		BrokenField{ "textureWebp",
					 "/textures/0",
					 { { "extensions", { { "EXT_texture_webp", { { "source", 0 } } } } } },
					 "textures[0]: its image exists only through EXT_texture_webp" },
		BrokenField{ "textureBasis",
					 "/textures/0",
					 { { "extensions", { { "KHR_texture_basisu", { { "source", 0 } } } } } },
					 "textures[0]: its image exists only through KHR_texture_basisu" },
		BrokenField{ "samplerWrap", "/samplers/0/wrapS", 10496, "samplers[0].wrapS: is 10496" },
		BrokenField{ "imageView", "/images/0/bufferView", 0, "images[0]: is no image in a known format" },
		BrokenField{ "imageBoth", "/images/0/uri", "a.png", "images[0]: exactly one of bufferView and uri is right" },
		BrokenField{ "displacementTexture", "/materials/0/extensions/KHR_materials_displacement/displacementGeometryTexture/index", 4,
					 "displacementGeometryTexture.index: is 4" },
		BrokenField{ "displacementFactor", "/materials/0/extensions/KHR_materials_displacement/displacementGeometryFactor", 1e200,
					 "displacementGeometryFactor: is 1e+200, which is too large" },
		BrokenField{ "displacementText", "/materials/0/extensions/KHR_materials_displacement", "high", "is of type string, but an object is right" },
		BrokenField{ "cameraType", "/cameras/0/type", "fisheye", "cameras[0].type: is neither perspective nor orthographic" },
		BrokenField{ "cameraMissing", "/cameras/0/type", "orthographic", "cameras[0].orthographic: is missing" },
		BrokenField{ "cameraAngle", "/cameras/0/perspective/yfov", 4, "cameras[0].perspective.yfov: is 4" },
		BrokenField{ "cameraNear", "/cameras/0/perspective/znear", 0, "cameras[0].perspective.znear: is 0" },
		BrokenField{ "requiredUnknown", "/extensionsRequired", Json::array({ "VENDOR_magic" }), "VENDOR_magic is required, but not supported" },
		BrokenField{ "requiredMeshopt", "/extensionsRequired", Json::array({ "EXT_meshopt_compression" }), "EXT_meshopt_compression is required" },
		BrokenField{ "requiredWrongType", "/extensionsRequired", Json::array({ 1 }),
					 "extensionsRequired[0]: is of type number, but a string is right" }),
	[](const testing::TestParamInfo<BrokenField>& broken) { return std::string(broken.param.name); });

TEST(gltfRefusals, sparseIndicesMustIncrease)
{
	GltfFile file = squareFile();
	const uint8_t indices[2] = { 2, 2 };
	const float values[6] = {};
	const size_t index_view = file.addView(indices, sizeof(indices));
	const size_t value_view = file.addView(values, sizeof(values));
	file.json["accessors"][0]["sparse"] = { { "count", 2 },
											{ "indices", { { "bufferView", index_view }, { "componentType", 5121 } } },
											{ "values", { { "bufferView", value_view } } } };
	expectRefused(file.import(), "accessors[0].sparse.indices: index 1 is 2, but strictly increasing values below 4 are right");
}

TEST(gltfRefusals, anIndexBeyondTheVerticesIsNamed)
{
	GltfFile file = squareFile();
	file.json["meshes"][0]["primitives"][0]["indices"] = file.addIndices({ 0, 1, 2, 0, 4, 3 });
	expectRefused(file.import(), "meshes[0].primitives[0].indices: index 4 is 4, but POSITION has 4 vertices: values from 0 to 3 are right");
}

TEST(gltfRefusals, indicesWithoutAViewAreRefusedWithTheirPlace)
{
	GltfFile file = squareFile();
	file.json["accessors"][3].erase("bufferView");
	expectRefused(file.import(), "meshes[0].primitives[0].indices: accessors[3] has no bufferView");
}

TEST(gltfRefusals, namesWithLineBreaksStayOnOneLine)
{
	GltfFile file = squareFile();
	file.json["extensionsRequired"] = { "BAD\nname" };
	expectRefused(file.import(), "BAD?name is required");
	file.json.erase("extensionsRequired");
	file.json["extensionsUsed"] = { "BAD\nname" };
	IMPORTED(scene, file.import());
	EXPECT_TRUE(hasWarning(scene, "BAD?name"));
}

TEST(gltfRefusals, aTexcoordSetAboveWhatIsReadIsRefused)
{
	GltfFile file = fullFile();
	file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 0x7fffffff;
	expectRefused(file.importGlb(), "baseColorTexture.texCoord: is 2147483647, but an integer from 0 to 31 is right");
}

TEST(gltfRefusals, meshoptBuffersWithoutFallbackDataAreRefusedByName)
{
	GltfFile file = squareFile();
	file.json["buffers"] = { { { "byteLength", file.binary.size() },
							   { "extensions", { { "EXT_meshopt_compression", { { "fallback", true } } } } } } };
	expectRefused(file.import(), "buffers[0]: EXT_meshopt_compression is not supported");
}

TEST(gltfRefusals, integerColoursThatAreNotNormalizedAreRefused)
{
	GltfFile file = squareFile();
	const size_t colors = file.add<uint8_t>(std::vector<uint8_t>(16), "VEC4", 5121, false);
	file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colors;
	expectRefused(file.import(), "attributes.COLOR_0: is VEC4 of UNSIGNED_BYTE, but integer colours must be normalized");
}

TEST(gltfRefusals, brokenDracoStreamsAndMissingAttributesAreRefused)
{
	const TemporaryFolder folder;
	std::vector<std::byte> stream = readBytes(dataFile("draco_grid.bin"));
	Json description = Json::parse(readBytes(dataFile("draco_grid.gltf")), nullptr, true);
	GltfFile file;
	file.json = description;
	writeBytes(folder.path / "draco_grid.bin", stream);
	file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["NORMAL"] = 17;
	expectRefused(importGltf(file.write(folder.path)), "attributes.NORMAL: is 17, but the Draco stream has no attribute of that number");
	file.json = description;
	file.json["accessors"][2]["type"] = "VEC4";
	expectRefused(importGltf(file.write(folder.path)), "the Draco stream has 2 components, but accessors[2] is VEC4");
	file.json = description;
	stream[0] = std::byte(0);
	writeBytes(folder.path / "draco_grid.bin", stream);
	expectRefused(importGltf(file.write(folder.path)), "KHR_draco_mesh_compression: cannot be decoded");
}

static Result<ImportedScene> importText(const std::string& text, const char* name = "file.gltf")
{
	const TemporaryFolder folder;
	const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
	writeBytes(folder.path / name, { bytes.begin(), bytes.end() });
	return importGltf(folder.path / name);
}

TEST(gltfRefusals, textThatIsNoGltfIsRefusedInOneLine)
{
	expectRefused(importText(""), "JSON: ");
	expectRefused(importText("\n\n{ \"asset\": \n"), "JSON: parse error at line ");
	expectRefused(importText("[]"), "JSON: is of type array, but an object is right");
	expectRefused(importText("{}"), "asset: is missing, but required");
	expectRefused(importText("solid stl"), "JSON: ");
	expectRefused(importText("{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"scale\":[1e999,1,1]}]}"), "JSON: ");
	expectRefused(importText("{\"asset\":{\"version\":\"2.\xff\"}}"), "JSON: ");
	expectRefused(importText("{\"asset\":{\"version\":\"2.0\"}}"), "has nothing to draw");
}

TEST(gltfRefusals, deepNestingIsRefusedBeforeAnythingRecurses)
{
	const std::string deep(1000000, '[');
	expectRefused(importText("{\"asset\":{\"version\":\"2.0\"},\"extras\":" + deep), "JSON: is nested 1000001 levels deep");
	const std::string brackets_in_text(1000, '[');
	expectRefused(importText("{\"asset\":{\"version\":\"2.0\"},\"extras\":\"\\\"" + brackets_in_text + "\"}"), "has nothing to draw");
}

// A .glb of the square with four bytes at `offset` replaced.
static Result<ImportedScene> importPatchedGlb(size_t offset, uint32_t value)
{
	const TemporaryFolder folder;
	const std::filesystem::path path = squareFile().writeGlb(folder.path);
	std::vector<std::byte> bytes = readBytes(path);
	std::memcpy(bytes.data() + offset, &value, 4);
	writeBytes(path, bytes);
	return importGltf(path);
}

TEST(gltfRefusals, brokenGlbHeadersAreNamed)
{
	expectRefused(importPatchedGlb(4, 1), "GLB header: version is 1, but 2 is right");
	expectRefused(importPatchedGlb(8, 0xffffffff), "GLB header: length is 4294967295");
	expectRefused(importPatchedGlb(8, 4), "GLB header: length is 4");
	expectRefused(importPatchedGlb(12, 0xffffffff), "GLB chunk 0: length is 4294967295");
	expectRefused(importPatchedGlb(12, 0), "GLB chunk ");
	expectRefused(importPatchedGlb(16, 0x004e4942), "GLB chunk 0: type is 0x004e4942");
	expectRefused(importText("glTF\2\0\0", "short.glb"), "GLB header: the file ends after");
}

}  // namespace tessera
