// Moon, boulders, and the scenes made of many instances.
#include "base/parallel.h"
#include "scene/builtin/noise.h"
#include "scene/builtin/parts.h"
#include "scene/builtin/scenes.h"

#include <algorithm>
#include <cmath>

namespace tessera::builtin
{

// --- moon -------------------------------------------------------------------------------------------------------------------------

static constexpr CubeAtlas kMoonAtlas = { 384, 16 };

struct Crater
{
	vec3 center;   // unit length
	float radius;  // of the rim, in radii of the moon
};

// Oldest first: large ones are old.
static std::vector<Crater> makeCraters()
{
	constexpr int kCount = 700;
	std::vector<Crater> craters(kCount);
	Random random(2024);
	for (int i = 0; i < kCount; ++i)
	{
		const float age = float(i) / float(kCount);
		const float size = random.next();
		craters[size_t(i)] = { random.direction(),
							   0.02f + 0.34f * (1 - age) * (1 - age) * (1 - age) * (1 - age) * size + 0.05f * size * size * size };
	}
	return craters;
}

// Changes the height (in moon radii) at distance d * radius from a crater's centre: bowl, raised rim, thin blanket outside.
static float cratered(float height, float d, float radius)
{
	if (d >= 2.2f)
		return height;
	const float depth = 0.20f * radius / (1.0f + 2.5f * radius);
	const float blanket = smoothStep(2.2f, 0.95f, d);
	const float rim = 0.50f * depth * blanket * blanket * blanket;
	if (d >= 1.0f)
		return height + rim;
	// Inside, the older ground is mostly gone. Larger bowls have flat floors.
	const float bowl = std::max(d * d, 0.08f + 0.8f * radius) - 1.0f;
	return height * (0.25f + 0.75f * smoothStep(0.6f, 1.0f, d)) + rim + depth * bowl;
}

static float moonHeight(vec3 p, const std::vector<const Crater*>& craters)
{
	const float rough = fractalNoise(p * 9.0f, 5, 5);
	const vec3 jagged = p + 0.006f * vec3(gradientNoise(p * 17.0f, 6), gradientNoise(p * 17.0f, 7), gradientNoise(p * 17.0f, 8));
	float height = 0.020f * fractalNoise(p * 2.2f, 4, 4) + 0.004f * rough;
	for (const Crater* crater : craters)
	{
		const vec3 way = jagged - crater->center;
		const float squared = glm::dot(way, way), reach = 2.2f * crater->radius;
		if (squared < reach * reach)
			height = cratered(height, std::sqrt(squared) / crater->radius, crater->radius);
	}
	return height + 0.0022f * rough;
}

// Fills one square tile; only the craters that can reach it are asked per texel.
static void fillMoonTile(HeightField& heights, uint32_t x0, uint32_t y0, uint32_t size, const std::vector<Crater>& craters)
{
	const vec3 middle = kMoonAtlas.direction(x0 + size / 2, y0 + size / 2);
	const vec3 corner = kMoonAtlas.direction(x0, y0);
	const float extent = 1.5f * std::sqrt(glm::dot(corner - middle, corner - middle)) + 0.05f;
	std::vector<const Crater*> near_craters;
	for (const Crater& crater : craters)
	{
		const vec3 way = crater.center - middle;
		const float reach = extent + 2.2f * crater.radius;
		if (glm::dot(way, way) < reach * reach)
			near_craters.push_back(&crater);
	}
	for (uint32_t y = y0; y < y0 + size; ++y)
		for (uint32_t x = x0; x < x0 + size; ++x)
			heights.at(x, y) = moonHeight(kMoonAtlas.direction(x, y), near_craters);
}

uint32_t addMoonMesh(ImportedScene& scene)
{
	constexpr uint32_t kTile = 32;
	const std::vector<Crater> craters = makeCraters();
	HeightField heights(kMoonAtlas.width(), kMoonAtlas.height());
	const uint32_t columns = heights.width / kTile;
	parallelFor(columns * (heights.height / kTile),
				[&](size_t i) { fillMoonTile(heights, uint32_t(i) % columns * kTile, uint32_t(i) / columns * kTile, kTile, craters); });
	const auto [low, high] = std::minmax_element(heights.values.begin(), heights.values.end());
	const float offset = *low, factor = *high - *low;
	heights.normalize();

	Image color = colorImage("moon color", heights.width, heights.height, [&](uint32_t x, uint32_t y) {
		const vec3 p = kMoonAtlas.direction(x, y);
		const float maria = smoothStep(-0.05f, 0.30f, fractalNoise(p * 1.7f, 4, 9));
		const float grain = 0.06f * fractalNoise(p * 30.0f, 3, 10);
		return glm::mix(vec3(0.69f, 0.67f, 0.64f), vec3(0.42f, 0.41f, 0.42f), maria) + grain + 0.30f * (heights.at(x, y) - 0.55f);
	});
	const uint32_t color_texture = addTexture(scene, std::move(color), Wrap::ClampToEdge, Wrap::ClampToEdge);
	const uint32_t height_texture = addTexture(scene, heightImage("moon height", heights), Wrap::ClampToEdge, Wrap::ClampToEdge);
	scene.materials.push_back(displacedMaterial("moon", color_texture, height_texture, factor, offset, 0.95f));
	Primitive sphere = cubeSphere(10, kMoonAtlas);
	sphere.material = uint32_t(scene.materials.size() - 1);
	return addMesh(scene, "moon", { std::move(sphere) });
}

// --- boulders ---------------------------------------------------------------------------------------------------------------------

static constexpr CubeAtlas kRockAtlas = { 256, 16 };

struct RockPlane
{
	vec3 normal;
	float distance;
};

// A boulder is a ball cut by planes, with worn edges and a rough skin; the height is its radius.
static float rockRadius(vec3 p, const std::vector<RockPlane>& planes)
{
	const vec3 q = p + 0.05f * vec3(gradientNoise(p * 3.0f, 1), gradientNoise(p * 3.0f, 2), gradientNoise(p * 3.0f, 3));
	float radius = 1.0f, second = 1.0f;
	for (const RockPlane& plane : planes)
	{
		const float facing = glm::dot(q, plane.normal);
		const float reach = facing > 0.05f ? plane.distance / facing : 2.0f;
		second = std::min(second, std::max(reach, radius));
		radius = std::min(radius, reach);
	}
	const float worn = 0.25f * (1.0f - smoothStep(0.0f, 0.10f, second - radius));
	const float skin = ridgedNoise(p * 2.6f, 5, 31) - 0.5f;
	return radius - 0.06f * worn + 0.055f * skin + 0.018f * fractalNoise(p * 11.0f, 4, 41);
}

uint32_t addRockMesh(ImportedScene& scene, uint32_t grid)
{
	Random random(77);
	std::vector<RockPlane> planes(22);
	for (RockPlane& plane : planes)
		plane = { random.direction(), random.next(0.66f, 0.92f) };
	HeightField heights(kRockAtlas.width(), kRockAtlas.height());
	forEachTexel(heights.width, heights.height, [&](uint32_t x, uint32_t y) { heights.at(x, y) = rockRadius(kRockAtlas.direction(x, y), planes); });
	const auto [low, high] = std::minmax_element(heights.values.begin(), heights.values.end());
	const float lowest = *low, highest = *high;
	heights.normalize();

	Image color = colorImage("boulder color", heights.width, heights.height, [&](uint32_t x, uint32_t y) {
		const vec3 p = kRockAtlas.direction(x, y);
		const float veins = ridgedNoise(p * 3.1f, 4, 51);
		const vec3 stone = glm::mix(vec3(0.36f, 0.32f, 0.29f), vec3(0.60f, 0.54f, 0.47f), smoothStep(0.1f, 0.9f, heights.at(x, y)));
		return glm::mix(stone, vec3(0.52f, 0.38f, 0.27f), 0.45f * smoothStep(0.5f, 0.85f, veins)) + 0.08f * fractalNoise(p * 21.0f, 3, 61);
	});
	const uint32_t color_texture = addTexture(scene, std::move(color), Wrap::ClampToEdge, Wrap::ClampToEdge);
	const uint32_t height_texture = addTexture(scene, heightImage("boulder height", heights), Wrap::ClampToEdge, Wrap::ClampToEdge);

	// The base sphere lies in the middle of the heights.
	Primitive sphere = cubeSphere(grid, kRockAtlas);
	const float middle = 0.5f * (lowest + highest);
	for (vec3& position : sphere.positions)
		position *= middle;
	scene.materials.push_back(displacedMaterial("boulder", color_texture, height_texture, highest - lowest, lowest - middle, 0.9f));
	sphere.material = uint32_t(scene.materials.size() - 1);
	return addMesh(scene, "boulder", { std::move(sphere) });
}

// --- scenes of instances ------------------------------------------------------------------------------------------------------------

// A boulder of this size at `place`, turned at random and stretched a little.
static dmat4 boulderPlacement(Random& random, dvec3 place, double size)
{
	const dvec3 axis = glm::normalize(dvec3(random.direction()));
	const double turns = random.next();
	const dvec3 stretch = size * dvec3{ 1.0, random.next(0.65f, 0.95f), random.next(0.8f, 1.1f) };  // braces: drawn in this order
	dmat4 world = rotation(axis, turns);
	for (int column = 0; column < 3; ++column)
		world[column] *= stretch[column];
	world[3] = dvec4(place, 1);
	return world;
}

// Sand with ripples under a field of `half` to each side.
static void addSand(ImportedScene& scene, float half)
{
	constexpr uint32_t kSize = 512;
	HeightField heights(kSize, kSize);
	forEachTexel(kSize, kSize, [&](uint32_t x, uint32_t y) {
		const vec2 uv = vec2(float(x) + 0.5f, float(y) + 0.5f) / float(kSize);
		const float bend = 0.20f * tileableNoise(uv, 3, 3, 81);
		const float crest = float(sineOfTurns(double(9.0f * (uv.y + bend)) + double(uv.x)));
		heights.at(x, y) = 0.16f * crest + tileableNoise(uv, 4, 4, 82) + 0.10f * tileableNoise(uv, 60, 3, 83);
	});
	heights.normalize();
	Image color = colorImage("sand color", kSize, kSize, [&](uint32_t x, uint32_t y) {
		return glm::mix(vec3(0.50f, 0.40f, 0.29f), vec3(0.74f, 0.63f, 0.47f), heights.at(x, y));
	});
	const uint32_t color_texture = addTexture(scene, std::move(color), Wrap::Repeat, Wrap::Repeat);
	const uint32_t height_texture = addTexture(scene, heightImage("sand height", heights), Wrap::Repeat, Wrap::Repeat);
	scene.materials.push_back(displacedMaterial("sand", color_texture, height_texture, 0.35f, -0.2f, 0.95f));
	Primitive ground;
	const float tiles = half / 3.0f;
	addGrid(ground, { -half, 0, half }, { 2 * half, 0, 0 }, { 0, 0, -2 * half }, 24, 24, { 0, tiles }, { tiles, 0 });
	ground.material = uint32_t(scene.materials.size() - 1);
	scene.instances.push_back({ addMesh(scene, "sand", { std::move(ground) }), dmat4(1) });
}

ImportedScene makeInstances(uint32_t count)
{
	ImportedScene scene;
	const uint32_t mesh = addRockMesh(scene, 6);
	Random random(5);
	uint32_t side = 1;
	while (side * side < count)
		++side;
	for (uint32_t i = 0; i < count; ++i)
	{
		const double x = double(i % side) - 0.5 * (side - 1) + 0.5 * random.next(-1, 1);
		const double z = double(i / side) - 0.5 * (side - 1) + 0.5 * random.next(-1, 1);
		const double chance = random.next();
		const double size = 0.28 + 0.42 * chance * chance * chance;
		scene.instances.push_back({ mesh, boulderPlacement(random, { x, 0.30 * size, z }, size) });
	}
	const double half = 0.5 * side;
	addSand(scene, float(half) + 4);
	scene.cameras.push_back(lookAtCamera({ 0.25 * half, 1.2 + 0.16 * half, half + 2.0 }, { 0, -0.12 * half, 0.1 * half }, 50));
	return scene;
}

// Places `count` boulders in two bands around the y axis, larger ones rarer.
static void addRing(ImportedScene& scene, uint32_t mesh, uint32_t count, const dmat4& tilt)
{
	Random random(9);
	for (uint32_t i = 0; i < count; ++i)
	{
		const bool outer = random.next() < 0.45f;
		const double radius = outer ? random.next(1.92f, 2.15f) : random.next(1.50f, 1.80f);
		const double turns = random.next();
		const double lift = 0.022 * (random.next(-1, 1) + random.next(-1, 1));
		const double chance = random.next();
		const double size = 0.006 + 0.012 * chance + 0.045 * chance * chance * chance * chance * chance * chance * chance;
		const dvec3 place = { radius * cosineOfTurns(turns), lift, radius * sineOfTurns(turns) };
		scene.instances.push_back({ mesh, tilt * boulderPlacement(random, place, size) });
	}
}

ImportedScene makeShowcase(uint32_t count)
{
	ImportedScene scene;
	const uint32_t planet = addPlanetMesh(scene);
	const uint32_t moon = addMoonMesh(scene);
	const uint32_t rock = addRockMesh(scene, 3);
	scene.instances.push_back({ planet, rotation({ 0, 0, 1 }, 0.03) * rotation({ 0, 1, 0 }, 0.0) });
	dmat4 moon_world = rotation({ 0, 1, 0 }, 0.4);
	for (int column = 0; column < 3; ++column)
		moon_world[column] *= 0.27;
	moon_world[3] = dvec4(-1.55, 0.78, -0.9, 1);
	scene.instances.push_back({ moon, moon_world });
	addRing(scene, rock, count, rotation({ 0, 0, 1 }, 0.035) * rotation({ 1, 0, 0 }, 0.015));
	scene.cameras.push_back(lookAtCamera({ 0.55, 0.85, 3.3 }, { 0, 0.03, 0 }, 42));
	return scene;
}

}  // namespace tessera::builtin
