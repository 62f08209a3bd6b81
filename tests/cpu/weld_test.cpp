// Welding and what hangs on it: fans, densities, attributes.
#include "build_test_scenes.h"
#include "scene/build/color_texture.h"
#include "scene/build/mesh_vertices.h"
#include "scene/build/weld.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <numeric>

namespace tessera::test
{

namespace
{

// Fans by their definition: every pair of edges with equal ends joins the corners at both.
std::vector<uint32_t> weldsByDefinition(const std::vector<vec3>& positions)
{
	std::vector<uint32_t> welds(positions.size());
	std::iota(welds.begin(), welds.end(), 0u);
	const auto unite = [&](uint32_t a, uint32_t b) {
		const uint32_t from = std::max(welds[a], welds[b]), to = std::min(welds[a], welds[b]);
		std::replace(welds.begin(), welds.end(), from, to);
	};
	for (uint32_t a = 0; a < positions.size(); ++a)
		for (uint32_t b = 0; b < positions.size(); ++b)
			for (const bool turned : { false, true })
			{
				const uint32_t first = turned ? nextCorner(b) : b, second = turned ? b : nextCorner(b);
				if (positions[a] != positions[first] || positions[nextCorner(a)] != positions[second])
					continue;
				unite(a, first);
				unite(nextCorner(a), second);
			}
	return welds;
}

BuiltScene built(const ImportedScene& imported)
{
	Result<BuiltScene> scene = buildScene(imported);
	EXPECT_TRUE(scene.has_value()) << scene.error().message;
	return std::move(*scene);
}

ImportedScene quadScene(vec2 size, uvec2 map_size)
{
	ImportedScene scene;
	Primitive quad;
	quad.material = addDisplaced(scene, noiseImage(map_size.x, map_size.y, TexelFormat::U8, 1), 1, 0);
	for (uint32_t i = 0; i < 4; ++i)
	{
		const vec2 uv(float(i % 2), float(i / 2));
		addVertex(quad, vec3(uv * size, 0), vec3(0, 0, 1), uv);
	}
	addTriangle(quad, 0, 1, 3);
	addTriangle(quad, 0, 3, 2);
	addPlacedMesh(scene, { quad });
	return scene;
}

}  // namespace

TEST(weld, cornersAreWeldedAsTheDefinitionSays)
{
	for (uint32_t seed = 0; seed < 40; ++seed)
	{
		const ImportedScene scene = soupScene(seed, 4 + seed);
		const MeshCorners corners = layOutCorners(scene.meshes[0]);
		const MeshWeld weld = weldMesh(corners);
		const std::vector<uint32_t> expected = weldsByDefinition(corners.positions);
		for (uint32_t corner = 0; corner < expected.size(); ++corner)
		{
			EXPECT_EQ(weld.first_corners[weld.corner_welds[corner]], expected[corner]);
			EXPECT_LE(weld.edge_owners[corner], corner);
		}
		EXPECT_TRUE(std::is_sorted(weld.first_corners.begin(), weld.first_corners.end()));
	}
}

TEST(weld, boundaryAndNonManifoldEdgesAreCounted)
{
	const BuiltScene quad = built(quadScene(vec2(1), uvec2(4)));
	EXPECT_EQ(quad.traits.boundary_edges, 4u);
	EXPECT_EQ(quad.traits.nonmanifold_edges, 0u);
	EXPECT_EQ(built(nonManifoldScene()).traits.nonmanifold_edges, 2u);
	EXPECT_EQ(built(cubeScene(2)).traits.boundary_edges, 0u);
}

TEST(density, isTexelsPerMeshUnit)
{
	const BuiltScene scene = built(quadScene(vec2(2, 0.5f), uvec2(64, 16)));
	for (const float density : scene.densities)
		EXPECT_FLOAT_EQ(density, 32);
}

TEST(density, isZeroWithoutTextureArea)
{
	ImportedScene imported = quadScene(vec2(1), uvec2(4));
	for (vec2& uv : imported.meshes[0].primitives[0].texcoords[0])
		uv.y = 0.5f;
	EXPECT_EQ(built(imported).densities, std::vector<float>(4, 0.0f));
}

TEST(density, isEqualToTheBitForAWeldedVertexAndMap)
{
	for (const NamedScene& named : allScenes())
	{
		const BuiltScene scene = built(named.scene);
		std::map<std::pair<uint32_t, uint32_t>, float> densities;
		for (const ClusterRecord& cluster : scene.clusters)
			for (uint32_t v = cluster.first_vertex; v < cluster.first_vertex + clusterVertices(cluster); ++v)
			{
				const uint32_t map = scene.material_height_maps[cluster.material];
				EXPECT_EQ(densities.emplace(std::pair(scene.weld_ids[v], map), scene.densities[v]).first->second, scene.densities[v]) << named.name;
				if (map == NO_INDEX)
				{
					EXPECT_EQ(scene.densities[v], 0.0f);
					EXPECT_EQ(scene.uvs[v], vec2(0));
				}
			}
	}
}

TEST(seams, areAbsentWhereEverythingAgrees)
{
	const BuiltScene mirrored = built(mirroredScene());
	EXPECT_EQ(mirrored.traits.seam_edges, 0u);
	EXPECT_TRUE(mirrored.seam_edges.empty() && mirrored.seam_corners.empty());
	EXPECT_TRUE(mirrored.first_seam_edges.empty() && mirrored.seam_corner_indices.empty());
}

TEST(seams, aSphereHasOneSeamAlongAMeridian)
{
	const BuiltScene sphere = built(sphereScene(12, 24, TexelFormat::U8, Wrap::Repeat));
	// 12 segments of the meridian, and around each pole 24 triangles whose tips have coordinates of their own: 23 edges of them differ.
	EXPECT_EQ(sphere.traits.seam_edges, 12u + 2 * 23u);
}

TEST(vertexData, textureTransformsAreAppliedInDoubleAndCleaned)
{
	TextureUse use;
	use.row0 = dvec3(0, -2, 1);
	use.row1 = dvec3(1e300, 0, 0);
	EXPECT_EQ(transformUv(use, vec2(1, 0.25f)), vec2(0.5f, 0));  // beyond the floats: 0
	use.row1 = dvec3(-1, 0, 0);
	EXPECT_FALSE(std::signbit(transformUv(use, vec2(0, 0)).y));
}

TEST(vertexData, colorsAndColorCoordinatesAreThereWhenTheSceneHasThem)
{
	ImportedScene imported = quadScene(vec2(1), uvec2(4));
	imported.materials[0].displacement.reset();
	imported.materials[0].base_color_texture = TextureUse{ .texture = 0, .texcoord = 0, .row0 = dvec3(2, 0, 0), .row1 = dvec3(0, 2, 0) };
	imported.meshes[0].primitives[0].colors.assign(4, vec4(1, 0.5f, -3, 7));
	const BuiltScene scene = built(imported);
	ASSERT_EQ(scene.colors, std::vector<uint32_t>(4, 0xff0080ffu));
	EXPECT_TRUE(scene.uvs.empty());
	for (size_t v = 0; v < 4; ++v)
		EXPECT_EQ(scene.color_uvs[v], 2.0f * vec2(scene.positions[v]));
	ASSERT_EQ(scene.color_textures.size(), 1u);
	EXPECT_EQ(scene.materials[0].base_color_texture, 0u);
}

TEST(colorTexture, everyFormatAndChannelCountBecomesEightBitColor)
{
	for (const TexelFormat format : { TexelFormat::U8, TexelFormat::U16, TexelFormat::F32 })
		for (uint32_t channels = 1; channels <= 4; ++channels)
		{
			const double full = format == TexelFormat::U8 ? 255 : format == TexelFormat::U16 ? 65535 : 1;
			Image image = constantImage(channels, 1, format, full);
			image.width = 1;
			image.channels = channels;
			// The first channel is 0: grey follows it, alpha only where there is none of its own.
			std::memset(image.texels.data(), 0, image.texels.size() / channels);
			const std::vector<uint8_t> rgba = buildColorTexture(image, Texture{}).rgba;
			const uint8_t others = channels <= 2 ? 0 : 255;
			EXPECT_EQ(rgba, (std::vector<uint8_t>{ 0, others, others, 255 })) << channels;
		}
}

TEST(materials, oneHeightMapPerImageWrapFactorAndOffset)
{
	ImportedScene imported;
	std::vector<Primitive> primitives(4, quadScene(vec2(1), uvec2(4)).meshes[0].primitives[0]);
	for (Primitive& primitive : primitives)
	{
		primitive.material = addDisplaced(imported, noiseImage(4, 4, TexelFormat::U8, 1), 1, 0);
		imported.materials.back().displacement->height.texture = 0;
	}
	imported.materials[1].displacement->factor = 2;
	imported.materials[2].displacement->height.row0 = dvec3(3, 0, 0);
	addPlacedMesh(imported, primitives);
	const BuiltScene scene = built(imported);
	EXPECT_EQ(scene.height_maps.size(), 2u);
	EXPECT_EQ(scene.material_height_maps, (std::vector<uint32_t>{ 0, 1, 0, 0 }));
	EXPECT_EQ(scene.height_maps[1].record.factor, 2.0f);
	EXPECT_EQ(scene.height_maps[1].texels, scene.height_maps[0].texels);
}

TEST(materials, whatNothingUsesIsNotDecoded)
{
	ImportedScene imported = quadScene(vec2(1), uvec2(4));
	addDisplaced(imported, Image{}, 1, 0);  // an image that was not decoded
	const BuiltScene scene = built(imported);
	EXPECT_EQ(scene.height_maps.size(), 1u);
	EXPECT_EQ(scene.materials.size(), 2u);
}

}  // namespace tessera::test
