// Geometry of glTF files: topology, accessors, values.
#include "gltf_file.h"
#include "scene/gltf/topology.h"

#include <array>
#include <cmath>
#include <limits>

namespace tessera
{

static constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A strip of `count` vertices that zigzags along x, counter-clockwise as seen from +z.
static std::vector<float> zigzag(size_t count)
{
	std::vector<float> values;
	for (size_t i = 0; i < count; ++i)
		values.insert(values.end(), { static_cast<float>(i / 2), i % 2 == 0 ? 0.0f : -1.0f, 0.0f });
	return values;
}

static float signedArea(const Primitive& primitive, size_t triangle)
{
	const vec3 a = primitive.positions[primitive.indices[3 * triangle]];
	const vec3 b = primitive.positions[primitive.indices[3 * triangle + 1]];
	const vec3 c = primitive.positions[primitive.indices[3 * triangle + 2]];
	return 0.5f * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
}

TEST(gltfTopology, aStripWithNVerticesGivesNMinus2TrianglesWithConsistentWinding)
{
	for (size_t n = 3; n < 12; ++n)
	{
		GltfFile file;
		file.addPrimitive({ { "POSITION", file.addFloats(zigzag(n), "VEC3") } }, 5);
		IMPORTED(scene, file.import());
		const Primitive& primitive = scene.meshes[0].primitives[0];
		ASSERT_EQ(primitive.indices.size(), 3 * (n - 2));
		for (size_t i = 0; i < n - 2; ++i)
			EXPECT_GT(signedArea(primitive, i), 0) << "triangle " << i << " of " << n - 2;
	}
}

TEST(gltfTopology, aFanWithNVerticesGivesNMinus2TrianglesAroundItsFirst)
{
	for (size_t n = 3; n < 12; ++n)
	{
		GltfFile file;
		std::vector<float> values = { 0, 0, 0 };
		for (size_t i = 1; i < n; ++i)
		{
			const float angle = 0.3f * static_cast<float>(i);
			values.insert(values.end(), { std::cos(angle), std::sin(angle), 0 });
		}
		file.addPrimitive({ { "POSITION", file.addFloats(values, "VEC3") } }, 6);
		IMPORTED(scene, file.import());
		const Primitive& primitive = scene.meshes[0].primitives[0];
		ASSERT_EQ(primitive.indices.size(), 3 * (n - 2));
		for (size_t i = 0; i < n - 2; ++i)
			EXPECT_GT(signedArea(primitive, i), 0);
	}
}

TEST(gltfTopology, degenerateTrianglesOfAStripAreKept)
{
	EXPECT_EQ(triangleList(kGltfTriangleStrip, { 0, 1, 2, 2, 3 }), (std::vector<uint32_t>{ 0, 1, 2, 1, 2, 2, 2, 2, 3 }));
	EXPECT_TRUE(triangleList(kGltfTriangleStrip, { 0, 1 }).empty());
	EXPECT_TRUE(triangleList(kGltfTriangleFan, {}).empty());
}

TEST(gltfTopology, aPrimitiveWithoutIndicesUsesItsVerticesInOrder)
{
	GltfFile file;
	file.addPrimitive({ { "POSITION", file.addFloats(zigzag(6), "VEC3") } });
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes[0].primitives[0].indices, (std::vector<uint32_t>{ 0, 1, 2, 3, 4, 5 }));
}

TEST(gltfTopology, indicesOf8And16And32BitsMeanTheSame)
{
	GltfFile file;
	const size_t positions = file.addFloats(zigzag(4), "VEC3");
	const std::array<size_t, 3> indices = { file.add<uint8_t>({ 2, 1, 3 }, "SCALAR", 5121), file.add<uint16_t>({ 2, 1, 3 }, "SCALAR", 5123),
											file.addIndices({ 2, 1, 3 }) };
	for (const size_t accessor : indices)
		file.addPrimitive({ { "POSITION", positions } })["indices"] = accessor;
	IMPORTED(scene, file.import());
	for (const Primitive& primitive : scene.meshes[0].primitives)
	{
		EXPECT_EQ(primitive.indices, scene.meshes[0].primitives[0].indices);
		EXPECT_EQ(primitive.positions[primitive.indices[0]], vec3(1, 0, 0));
	}
}

TEST(gltfTopology, verticesThatNoTriangleUsesAreLeftOutAndTheOthersKeepTheirOrder)
{
	GltfFile file;
	std::vector<float> values = zigzag(100);
	values[3 * 7] = kNan;  // lies between used vertices, but belongs to none
	const size_t positions = file.addFloats(values, "VEC3");
	std::vector<float> texcoords(200);
	for (size_t i = 0; i < 100; ++i)
		texcoords[2 * i] = static_cast<float>(i);
	const size_t uv = file.addFloats(texcoords, "VEC2");
	file.addPrimitive({ { "POSITION", positions }, { "TEXCOORD_0", uv } })["indices"] = file.addIndices({ 90, 5, 10, 10, 5, 6 });
	IMPORTED(scene, file.import());
	const Primitive& primitive = scene.meshes[0].primitives[0];
	EXPECT_EQ(primitive.positions, (std::vector<vec3>{ { 2, -1, 0 }, { 3, 0, 0 }, { 5, 0, 0 }, { 45, 0, 0 } }));
	EXPECT_EQ(primitive.texcoords[0], (std::vector<vec2>{ { 5, 0 }, { 6, 0 }, { 10, 0 }, { 90, 0 } }));
	EXPECT_EQ(primitive.indices, (std::vector<uint32_t>{ 3, 0, 2, 2, 0, 1 }));
}

TEST(gltfTopology, anIncompleteLastTriangleIsLeftOutWithAWarning)
{
	GltfFile file;
	file.addPrimitive({ { "POSITION", file.addFloats(zigzag(5), "VEC3") } });
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes[0].primitives[0].indices.size(), 3u);
	EXPECT_TRUE(hasWarning(scene, "meshes[0].primitives[0]: its number of indices is not a multiple of 3"));
}

TEST(gltfTopology, pointsAndLinesAreLeftOutByNameAndTheRestIsDrawn)
{
	GltfFile file = squareFile();
	for (int mode = 0; mode < 4; ++mode)
		file.addPrimitive({ { "POSITION", 0 } }, mode);
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes[0].primitives.size(), 1u);
	EXPECT_TRUE(hasWarning(scene, "meshes[0].primitives[1]: POINTS are not supported and left out"));
	EXPECT_TRUE(hasWarning(scene, "meshes[0].primitives[2] (and 2 more places): LINES are not supported and left out"));
}

TEST(gltfTopology, aFileOfNothingButPointsIsRefused)
{
	GltfFile file;
	file.addPrimitive({ { "POSITION", file.addFloats(zigzag(5), "VEC3") } }, 0);
	expectRefused(file.import(), "has nothing to draw");
	expectRefused(file.import(), "meshes[0].primitives[0]: POINTS are not supported");
}

TEST(gltfAccessor, missingNormalsAndTexcoordsGiveEmptyArrays)
{
	GltfFile file;
	file.addPrimitive({ { "POSITION", file.addFloats(zigzag(3), "VEC3") } });
	IMPORTED(scene, file.import());
	EXPECT_TRUE(scene.meshes[0].primitives[0].normals.empty());
	EXPECT_TRUE(scene.meshes[0].primitives[0].texcoords.empty());
	EXPECT_TRUE(scene.meshes[0].primitives[0].colors.empty());
}

// One triangle whose first vertex is (x, y, z) in the component type under test.
template <typename T>
static vec3 firstPosition(int component_type, bool normalized, T x, T y, T z)
{
	GltfFile file;
	file.addPrimitive({ { "POSITION", file.add<T>({ x, y, z, 1, 0, 0, 0, 1, 0 }, "VEC3", component_type, normalized) } });
	file.json["extensionsUsed"] = { "KHR_mesh_quantization" };
	file.json["extensionsRequired"] = { "KHR_mesh_quantization" };
	const Result<ImportedScene> scene = file.import();
	EXPECT_TRUE(scene) << scene.error().message;
	return scene ? scene->meshes[0].primitives[0].positions[0] : vec3(kNan);
}

TEST(gltfAccessor, quantizedPositionsFollowTheFormatsRules)
{
	EXPECT_EQ(firstPosition<int8_t>(5120, true, -128, 127, 64), vec3(-1, 1, 64.0f / 127.0f));
	EXPECT_EQ(firstPosition<int8_t>(5120, false, -128, 127, 64), vec3(-128, 127, 64));
	EXPECT_EQ(firstPosition<uint8_t>(5121, true, 0, 255, 51), vec3(0, 1, 0.2f));
	EXPECT_EQ(firstPosition<uint8_t>(5121, false, 0, 255, 51), vec3(0, 255, 51));
	EXPECT_EQ(firstPosition<int16_t>(5122, true, -32768, 32767, -32767), vec3(-1, 1, -1));
	EXPECT_EQ(firstPosition<int16_t>(5122, false, -32768, 32767, 5), vec3(-32768, 32767, 5));
	EXPECT_EQ(firstPosition<uint16_t>(5123, true, 0, 65535, 13107), vec3(0, 1, 0.2f));
	EXPECT_EQ(firstPosition<uint16_t>(5123, false, 0, 65535, 7), vec3(0, 65535, 7));
}

TEST(gltfAccessor, interleavedViewsAreReadByTheirStride)
{
	GltfFile file;
	std::vector<float> values;
	for (const vec3& p : { vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0) })
		values.insert(values.end(), { p.x, p.y, p.z, 9, 8, p.x * 0.5f, p.y * 0.5f });
	const size_t view = file.addView(values.data(), values.size() * 4, 28);
	file.json["accessors"] = { { { "bufferView", view }, { "componentType", 5126 }, { "type", "VEC3" }, { "count", 3 } },
							   { { "bufferView", view }, { "byteOffset", 20 }, { "componentType", 5126 }, { "type", "VEC2" }, { "count", 3 } } };
	file.addPrimitive({ { "POSITION", 0 }, { "TEXCOORD_0", 1 } });
	IMPORTED(scene, file.import());
	const Primitive& primitive = scene.meshes[0].primitives[0];
	EXPECT_EQ(primitive.positions, (std::vector<vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }));
	EXPECT_EQ(primitive.texcoords[0], (std::vector<vec2>{ { 0, 0 }, { 0.5f, 0 }, { 0, 0.5f } }));
}

// Replaces elements 1 and 3 of an accessor of vertices.
static Json sparseOf(GltfFile& file)
{
	const uint8_t indices[2] = { 1, 3 };
	const float values[6] = { 7, 8, 9, -1, -2, -3 };
	const size_t index_view = file.addView(indices, sizeof(indices));
	const size_t value_view = file.addView(values, sizeof(values));
	return { { "count", 2 },
			 { "indices", { { "bufferView", index_view }, { "componentType", 5121 } } },
			 { "values", { { "bufferView", value_view } } } };
}

TEST(gltfAccessor, sparseValuesReplaceElementsOfTheView)
{
	GltfFile file = squareFile();
	file.json["accessors"][0]["sparse"] = sparseOf(file);
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes[0].primitives[0].positions, (std::vector<vec3>{ { 0, 0, 0 }, { 7, 8, 9 }, { 1, 1, 0 }, { -1, -2, -3 } }));
}

TEST(gltfAccessor, aSparseAccessorWithoutAViewStartsFromZeros)
{
	GltfFile file = squareFile();
	file.json["accessors"][0]["sparse"] = sparseOf(file);
	file.json["accessors"][0].erase("bufferView");
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes[0].primitives[0].positions, (std::vector<vec3>{ { 0, 0, 0 }, { 7, 8, 9 }, { 0, 0, 0 }, { -1, -2, -3 } }));
}

TEST(gltfAccessor, sparseValuesOutsideTheUsedRangeAreSkipped)
{
	GltfFile file = squareFile();
	file.json["accessors"][0]["sparse"] = sparseOf(file);
	file.json["meshes"][0]["primitives"][0]["indices"] = file.addIndices({ 1, 2, 2 });
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes[0].primitives[0].positions, (std::vector<vec3>{ { 7, 8, 9 }, { 1, 1, 0 } }));
}

TEST(gltfValues, negativeZerosBecomePositiveAndTinyValuesZero)
{
	GltfFile file;
	file.addPrimitive({ { "POSITION", file.addFloats({ -0.0f, 0x1p-61f, -0x1p-61f, 0x1p-60f, -0x1p-60f, 1e-45f, 1, -2, 3 }, "VEC3") } });
	IMPORTED(scene, file.import());
	const std::vector<vec3>& positions = scene.meshes[0].primitives[0].positions;
	EXPECT_EQ(positions, (std::vector<vec3>{ { 0, 0, 0 }, { 0x1p-60f, -0x1p-60f, 0 }, { 1, -2, 3 } }));
	for (int c = 0; c < 3; ++c)
		EXPECT_FALSE(std::signbit(positions[0][c]));
}

TEST(gltfValues, normalsAreMadeUnitAndZeroOnesStayZero)
{
	GltfFile file;
	const size_t positions = file.addFloats(zigzag(6), "VEC3");
	const float infinity = std::numeric_limits<float>::infinity();
	const size_t normals = file.addFloats({ 0, 0, 5, 0, 0, 0, 0.6f, 0.8f, 0, kNan, 0, 0, infinity, 0, 0, -0.0f, -3e38f, 0 }, "VEC3");
	file.addPrimitive({ { "POSITION", positions }, { "NORMAL", normals } });
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes[0].primitives[0].normals,
			  (std::vector<vec3>{ { 0, 0, 1 }, { 0, 0, 0 }, { 0.6f, 0.8f, 0 }, { 0, 0, 0 }, { 0, 0, 0 }, { 0, -1, 0 } }));
	EXPECT_TRUE(hasWarning(scene, "attributes.NORMAL: 2 normals are not finite"));
}

TEST(gltfValues, aPositionThatIsNotFiniteIsRefusedWithAccessorAndElement)
{
	for (const float bad : { kNan, std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity() })
	{
		GltfFile file;
		std::vector<float> values = zigzag(6);
		values[3 * 4 + 1] = bad;
		file.addPrimitive({ { "POSITION", file.addFloats(values, "VEC3") } });
		expectRefused(file.import(), "meshes[0].primitives[0].attributes.POSITION: accessors[0], element 4 is not finite");
	}
}

TEST(gltfValues, texcoordsThatAreNotFiniteBecomeZeroWithAWarning)
{
	GltfFile file;
	const size_t positions = file.addFloats(zigzag(3), "VEC3");
	file.addPrimitive({ { "POSITION", positions }, { "TEXCOORD_0", file.addFloats({ kNan, 1, 2, 3, 4, kNan }, "VEC2") } });
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes[0].primitives[0].texcoords[0], (std::vector<vec2>{ { 0, 1 }, { 2, 3 }, { 4, 0 } }));
	EXPECT_TRUE(hasWarning(scene, "attributes.TEXCOORD_0: 2 coordinates are not finite and replaced by 0"));
}

TEST(gltfValues, vertexColoursAreKeptAndThreeComponentsGetAlphaOne)
{
	GltfFile file;
	const size_t positions = file.addFloats(zigzag(3), "VEC3");
	const size_t rgb = file.addFloats({ 1, 0, 0, 0, 1, 0, 0, 0, 1 }, "VEC3");
	const size_t rgba = file.add<uint8_t>({ 255, 0, 51, 255, 0, 0, 0, 0, 1, 2, 3, 4 }, "VEC4", 5121, true);
	file.addPrimitive({ { "POSITION", positions }, { "COLOR_0", rgb } });
	file.addPrimitive({ { "POSITION", positions }, { "COLOR_0", rgba } });
	IMPORTED(scene, file.import());
	EXPECT_EQ(scene.meshes[0].primitives[0].colors, (std::vector<vec4>{ { 1, 0, 0, 1 }, { 0, 1, 0, 1 }, { 0, 0, 1, 1 } }));
	EXPECT_EQ(scene.meshes[0].primitives[1].colors[0], vec4(1, 0, 0.2f, 1));
}

TEST(gltfContainer, aGlbGivesTheSameSceneAsTheGltf)
{
	const GltfFile file = squareFile();
	IMPORTED(text, file.import());
	IMPORTED(binary, file.importGlb());
	EXPECT_EQ(text.meshes[0].primitives[0].positions, binary.meshes[0].primitives[0].positions);
	EXPECT_EQ(text.meshes[0].primitives[0].indices, binary.meshes[0].primitives[0].indices);
}

TEST(gltfContainer, aDracoCompressedGridIsTheGrid)
{
	IMPORTED(scene, importGltf(dataFile("draco_grid.gltf")));
	const Primitive& primitive = scene.meshes[0].primitives[0];
	EXPECT_EQ(primitive.positions.size(), 25u);
	ASSERT_EQ(primitive.indices.size(), 3u * 32u);
	float area = 0;
	for (size_t i = 0; i < 32; ++i)
	{
		EXPECT_GT(signedArea(primitive, i), 0);
		area += signedArea(primitive, i);
	}
	EXPECT_NEAR(area, 1, 1e-3);
	for (size_t i = 0; i < 25; ++i)
	{
		EXPECT_NEAR(primitive.texcoords[0][i].x, primitive.positions[i].x, 1e-3);
		EXPECT_NEAR(primitive.normals[i].z, 1, 1e-3);
	}
}

}  // namespace tessera
