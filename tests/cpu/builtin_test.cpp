// The built-in scenes: the same bits everywhere, closed where they say so, valid as ImportedScene promises.
#include "scene/builtin.h"
#include "scene/builtin/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

namespace tessera
{
namespace
{

ImportedScene made(std::string_view name)
{
	Result<ImportedScene> scene = makeBuiltinScene(name);
	EXPECT_TRUE(scene.has_value()) << (scene ? "" : scene.error().message);
	return scene ? std::move(*scene) : ImportedScene();
}

// FNV-1a over raw bytes.
class Fingerprint
{
public:
	template <typename T>
	void add(const std::vector<T>& values)
	{
		const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
		for (size_t i = 0; i < values.size() * sizeof(T); ++i)
			value_ = (value_ ^ bytes[i]) * 0x100000001b3u;
	}
	uint64_t value() const { return value_; }

private:
	uint64_t value_ = 0xcbf29ce484222325u;
};

uint64_t fingerprint(const ImportedScene& scene)
{
	Fingerprint result;
	for (const Image& image : scene.images)
		result.add(image.texels);
	for (const Mesh& mesh : scene.meshes)
		for (const Primitive& primitive : mesh.primitives)
		{
			result.add(primitive.positions);
			result.add(primitive.normals);
			result.add(primitive.texcoords[0]);
			result.add(primitive.indices);
		}
	for (const Instance& instance : scene.instances)
		result.add(std::vector<dmat4>{ instance.world });
	return result.value();
}

using Point = std::tuple<float, float, float>;

// How often each directed edge between two positions occurs.
std::map<std::pair<Point, Point>, int> directedEdges(const Mesh& mesh)
{
	std::map<std::pair<Point, Point>, int> edges;
	for (const Primitive& primitive : mesh.primitives)
		for (size_t i = 0; i < primitive.indices.size(); ++i)
		{
			const size_t next = i % 3 == 2 ? i - 2 : i + 1;
			const vec3 a = primitive.positions[primitive.indices[i]], b = primitive.positions[primitive.indices[next]];
			++edges[{ { a.x, a.y, a.z }, { b.x, b.y, b.z } }];
		}
	return edges;
}

double signedVolume(const Mesh& mesh)
{
	double volume = 0;
	for (const Primitive& p : mesh.primitives)
		for (size_t i = 0; i < p.indices.size(); i += 3)
			volume +=
				glm::dot(dvec3(p.positions[p.indices[i]]), glm::cross(dvec3(p.positions[p.indices[i + 1]]), dvec3(p.positions[p.indices[i + 2]]))) /
				6;
	return volume;
}

// Every edge is shared by exactly two triangles, in opposite directions, and they face outward.
void expectClosed(const Mesh& mesh)
{
	const auto edges = directedEdges(mesh);
	size_t wrong = 0;
	for (const auto& [edge, count] : edges)
	{
		const auto opposite = edges.find({ edge.second, edge.first });
		wrong += count != 1 || opposite == edges.end() || opposite->second != 1 || edge.first == edge.second;
	}
	EXPECT_EQ(wrong, 0u) << mesh.name << ": edges not shared by exactly two triangles, of " << edges.size();
	EXPECT_GT(signedVolume(mesh), 1) << mesh.name;
}

void expectValidPrimitive(const ImportedScene& scene, const Primitive& primitive)
{
	const size_t count = primitive.positions.size();
	ASSERT_EQ(primitive.normals.size(), count);
	ASSERT_EQ(primitive.texcoords.size(), 1u);
	ASSERT_EQ(primitive.texcoords[0].size(), count);
	ASSERT_LT(primitive.material, scene.materials.size());
	ASSERT_EQ(primitive.indices.size() % 3, 0u);
	const uint32_t height = scene.materials[primitive.material].displacement->height.texture;
	const bool wraps = scene.textures[height].wrap_u == Wrap::Repeat;
	size_t wrong = 0;
	for (size_t i = 0; i < count; ++i)
	{
		const vec3 p = primitive.positions[i], n = primitive.normals[i];
		const vec2 uv = primitive.texcoords[0][i];
		for (int c = 0; c < 3; ++c)
			wrong += !std::isfinite(p[c]) || (p[c] == 0 && std::signbit(p[c])) || (p[c] != 0 && std::abs(p[c]) < 0x1p-60f);
		wrong += !(std::abs(glm::dot(n, n) - 1) < 1e-5f);
		wrong += !std::isfinite(uv.x) || !std::isfinite(uv.y);
		wrong += !wraps && (uv.x < 0 || uv.x > 1 || uv.y < 0 || uv.y > 1);
	}
	for (const uint32_t index : primitive.indices)
		wrong += index >= count;
	EXPECT_EQ(wrong, 0u);
}

void expectValidScene(const ImportedScene& scene)
{
	ASSERT_FALSE(scene.cameras.empty());
	EXPECT_FALSE(scene.instances.empty());
	for (const Image& image : scene.images)
		EXPECT_EQ(image.texels.size(), size_t(image.width) * image.height * image.channels * (image.format == TexelFormat::U16 ? 2 : 1));
	for (const Material& material : scene.materials)
		ASSERT_TRUE(material.displacement.has_value());
	for (const Mesh& mesh : scene.meshes)
		for (const Primitive& primitive : mesh.primitives)
			expectValidPrimitive(scene, primitive);
}

double heightTexel(const Image& image, uint32_t x, uint32_t y)
{
	uint16_t texel = 0;
	std::memcpy(&texel, &image.texels[2 * (size_t(y) * image.width + x)], 2);
	return texel / 65535.0;
}

const Image& heightMap(const ImportedScene& scene, const Material& material)
{
	return scene.images[scene.textures[material.displacement->height.texture].image];
}

void expectWholeRange(const Image& image)
{
	ASSERT_EQ(image.format, TexelFormat::U16);
	double low = 1, high = 0;
	for (uint32_t y = 0; y < image.height; ++y)
		for (uint32_t x = 0; x < image.width; ++x)
		{
			low = std::min(low, heightTexel(image, x, y));
			high = std::max(high, heightTexel(image, x, y));
		}
	EXPECT_EQ(low, 0) << image.name;
	EXPECT_EQ(high, 1) << image.name;
}

// Steps across the border of a repeated map are like those between any two columns or rows.
void expectTiles(const Image& image)
{
	double inside = 0, across_u = 0, across_v = 0;
	for (uint32_t i = 0; i < image.width; ++i)
	{
		for (uint32_t x = 1; x < image.width; ++x)
			inside += std::abs(heightTexel(image, x, i) - heightTexel(image, x - 1, i));
		across_u += std::abs(heightTexel(image, 0, i) - heightTexel(image, image.width - 1, i));
		across_v += std::abs(heightTexel(image, i, 0) - heightTexel(image, i, image.height - 1));
	}
	inside /= image.width - 1;
	EXPECT_LT(across_u, 2.5 * inside) << image.name;
	EXPECT_LT(across_v, 2.5 * inside) << image.name;
}

void expectSoundMap(const Texture& texture, const Image& image)
{
	expectWholeRange(image);
	if (texture.wrap_u == Wrap::Repeat)
		expectTiles(image);
}

double heightAt(const Image& image, vec2 uv)
{
	const double x = double(uv.x) * image.width - 0.5, y = double(uv.y) * image.height - 0.5;
	const uint32_t x0 = uint32_t(x), y0 = uint32_t(y);
	const double fx = x - x0, fy = y - y0;
	return (heightTexel(image, x0, y0) * (1 - fx) + heightTexel(image, x0 + 1, y0) * fx) * (1 - fy) +
		   (heightTexel(image, x0, y0 + 1) * (1 - fx) + heightTexel(image, x0 + 1, y0 + 1) * fx) * fy;
}

// Heights agree where the map's cells meet on the solid.
void expectSeamlessAtlas(const ImportedScene& scene, const Primitive& solid)
{
	const Material& material = scene.materials[solid.material];
	if (scene.textures[material.displacement->height.texture].wrap_u == Wrap::Repeat)
		return;
	const Image& image = heightMap(scene, material);
	std::map<Point, double> heights;
	double worst = 0;
	for (size_t i = 0; i < solid.positions.size(); ++i)
	{
		const vec3 p = solid.positions[i];
		const double height = heightAt(image, solid.texcoords[0][i]);
		const auto [found, is_new] = heights.insert({ { p.x, p.y, p.z }, height });
		worst = std::max(worst, std::abs(found->second - height));
	}
	EXPECT_LT(heights.size(), solid.positions.size());
	EXPECT_LT(worst, 0.02) << image.name;
}

struct Known
{
	const char* name;
	uint32_t solids;  // the first so many meshes are closed
	uint64_t fingerprint;
};

// A change of a scene changes every count and picture measured on it: change these numbers only on purpose.
constexpr Known kKnown[] = {
	{ "planet", 1, 0xa5dfbf359f70becbu }, { "showcase", 3, 0x0285c0c7f50e50a7u },  { "terrain", 0, 0xcf21e472ac53d2a0u },
	{ "bricks", 1, 0xfb52bb0c200a30b2u }, { "instances", 1, 0x46388b96b2d6cb23u }, { "quad", 0, 0x8197d81203d49f8cu },
	{ "cube", 1, 0xa4cafee34b22051au },   { "materials", 0, 0xaec9c046b30e20b9u },
};

class EachBuiltinScene : public testing::TestWithParam<Known>
{
};

// One test for all of it, since making a scene takes the longest.
TEST_P(EachBuiltinScene, isSoundAndTheSameBitsOnEveryPlatform)
{
	const Known& known = GetParam();
	const ImportedScene scene = made(known.name);
	EXPECT_EQ(scene.path, "builtin:" + std::string(known.name));
	expectValidScene(scene);
	for (const Material& material : scene.materials)
		expectSoundMap(scene.textures[material.displacement->height.texture], heightMap(scene, material));
	for (uint32_t i = 0; i < known.solids; ++i)
	{
		expectClosed(scene.meshes[i]);
		expectSeamlessAtlas(scene, scene.meshes[i].primitives[0]);
	}
	const uint64_t bits = fingerprint(scene);
	EXPECT_EQ(bits, known.fingerprint) << fmt::format("{{ \"{}\", {}, 0x{:016x}u }},", known.name, known.solids, bits);
}

INSTANTIATE_TEST_SUITE_P(all, EachBuiltinScene, testing::ValuesIn(kKnown), [](const auto& known) { return std::string(known.param.name); });

TEST(builtinScenes, areAllKnownToThisTest)
{
	ASSERT_EQ(builtinScenes().size(), std::size(kKnown));
	for (size_t i = 0; i < std::size(kKnown); ++i)
		EXPECT_EQ(builtinScenes()[i].name, kKnown[i].name);
}

TEST(builtinScenes, takeACountWhereTheySaySo)
{
	// One more for the ground.
	EXPECT_EQ(made("builtin:instances:10").instances.size(), 11u);
	EXPECT_EQ(made("instances").instances.size(), 1025u);
}

TEST(builtinScenes, refuseUnknownNamesAndCountsInOneLine)
{
	for (const std::string_view name :
		 { "", "plant", "planet:3", "instances:", "instances:0", "instances:-1", "instances:1000001", "instances:9x", "quad:" })
	{
		const Result<ImportedScene> scene = makeBuiltinScene(name);
		ASSERT_FALSE(scene.has_value()) << name;
		EXPECT_EQ(scene.error().code, ExitCode::BadInput);
		EXPECT_EQ(scene.error().message.find('\n'), std::string::npos);
	}
}

TEST(noise, sineOfTurnsIsASine)
{
	for (int i = -5000; i <= 5000; ++i)
	{
		const double turns = i / 1000.0;
		EXPECT_NEAR(builtin::sineOfTurns(turns), std::sin(turns * 6.283185307179586), 1e-8) << turns;
	}
	EXPECT_EQ(builtin::sineOfTurns(0), 0);
}

TEST(noise, staysInItsRange)
{
	builtin::Random random(1);
	float largest = 0;
	for (int i = 0; i < 20000; ++i)
	{
		const vec3 p = { random.next(-50, 50), random.next(-50, 50), random.next(-50, 50) };
		largest = std::max(largest, std::abs(builtin::gradientNoise(p, 3)));
		const float ridge = builtin::ridgedNoise(p, 5, 3);
		EXPECT_GE(ridge, 0);
		EXPECT_LE(ridge, 1.1f);
	}
	EXPECT_GT(largest, 0.5f);
	EXPECT_LT(largest, 1.6f);
}

}  // namespace
}  // namespace tessera
