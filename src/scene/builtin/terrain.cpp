// The terrain: an eroded mountain valley with a lake.
#include "scene/builtin/noise.h"
#include "scene/builtin/parts.h"
#include "scene/builtin/scenes.h"

#include <algorithm>
#include <cmath>

namespace tessera::builtin
{

static constexpr uint32_t kTexels = 1536;
static constexpr float kSide = 10;      // mesh units
static constexpr float kRelief = 2.6f;  // mesh units from the lake to the highest peak
static constexpr float kLake = 0.10f;   // height of the lake's surface before normalising

// Height at uv within the square, 0..1 or so.
static float groundHeight(vec2 uv)
{
	const vec2 p = uv * 4.0f + vec2(2.7f, 8.1f);
	const vec2 push = { valueNoiseWithGradient(p * 0.9f, 3).x, valueNoiseWithGradient(p * 0.9f, 4).x };
	const vec2 q = p + 0.30f * push;
	const float worn = 0.5f + 0.5f * erodedNoise(q, 11, 17);
	const float crests = ridgedNoise(vec3(q * 0.9f, 0.37f), 8, 19);
	// A valley runs through and ends before mountains at the far side.
	const float middle = 0.46f + 0.20f * (uv.y - 0.5f) + 0.09f * valueNoiseWithGradient(uv * vec2(1.0f, 4.0f), 5).x;
	const float aside = smoothStep(0.0f, 0.12f, (uv.x - middle) * (uv.x - middle));
	const float walls = std::max(aside, 0.85f * smoothStep(0.20f, 0.02f, uv.y));
	return worn * (0.28f + 0.34f * walls) + crests * (0.05f + 0.72f * walls) - 0.06f;
}

static vec3 groundColor(vec2 uv, float height, float steepness)
{
	const vec3 at = { uv * 40.0f, 0.5f };
	const float mottle = fractalNoise(at, 5, 71);
	vec3 grass = glm::mix(vec3(0.33f, 0.38f, 0.20f), vec3(0.22f, 0.29f, 0.15f), smoothStep(-0.4f, 0.4f, mottle));
	grass = glm::mix(grass, vec3(0.48f, 0.45f, 0.25f), smoothStep(0.28f, 0.50f, height + 0.10f * mottle));
	const vec3 rock = glm::mix(vec3(0.36f, 0.33f, 0.31f), vec3(0.52f, 0.48f, 0.44f), 0.5f + 0.8f * mottle);
	vec3 color = glm::mix(grass, rock, smoothStep(0.95f, 1.45f, steepness + 0.9f * height + 0.25f * mottle));
	const float snow = smoothStep(0.46f, 0.60f, height + 0.08f * mottle) * smoothStep(2.0f, 1.2f, steepness);
	color = glm::mix(color, vec3(0.88f, 0.91f, 0.94f), snow);
	return glm::mix(vec3(0.62f, 0.56f, 0.42f), color, smoothStep(0.002f, 0.009f, height));
}

ImportedScene makeTerrain(uint32_t quads)
{
	HeightField ground(kTexels, kTexels);
	forEachTexel(kTexels, kTexels,
				 [&](uint32_t x, uint32_t y) { ground.at(x, y) = groundHeight(vec2(float(x) + 0.5f, float(y) + 0.5f) / float(kTexels)) - kLake; });
	HeightField heights = ground;
	for (float& height : heights.values)
		height = std::max(height, 0.0f);
	heights.normalize();
	constexpr float kSlopeScale = kRelief / kSide * float(kTexels);
	Image color = colorImage("terrain color", kTexels, kTexels, [&](uint32_t x, uint32_t y) {
		const float depth = -ground.at(x, y);
		if (depth > 0)
			return glm::mix(vec3(0.22f, 0.42f, 0.42f), vec3(0.06f, 0.17f, 0.24f), smoothStep(0.0f, 0.05f, depth));
		const vec2 slope = heights.slope(x, y, false) * kSlopeScale;
		return groundColor(vec2(float(x), float(y)) / float(kTexels), heights.at(x, y), std::sqrt(glm::dot(slope, slope)));
	});

	ImportedScene scene;
	const uint32_t color_texture = addTexture(scene, std::move(color), Wrap::ClampToEdge, Wrap::ClampToEdge);
	const uint32_t height_texture = addTexture(scene, heightImage("terrain height", heights), Wrap::ClampToEdge, Wrap::ClampToEdge);
	scene.materials.push_back(displacedMaterial("terrain", color_texture, height_texture, kRelief, 0, 0.9f));
	Primitive grid;
	// Top of the map is far away (-z).
	addGrid(grid, { -kSide / 2, 0, kSide / 2 }, { kSide, 0, 0 }, { 0, 0, -kSide }, quads, quads, { 0, 1 }, { 1, 0 });
	scene.instances.push_back({ addMesh(scene, "terrain", { std::move(grid) }), dmat4(1) });
	scene.cameras.push_back(lookAtCamera({ -0.1, 1.55, 4.6 }, { 0.15, 0.85, 0 }, 52));
	return scene;
}

}  // namespace tessera::builtin
