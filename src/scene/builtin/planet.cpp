// The planet: continents from warped noise, ridged mountains on them, ice by latitude and height.
#include "scene/builtin/noise.h"
#include "scene/builtin/parts.h"
#include "scene/builtin/scenes.h"

#include <algorithm>
#include <cmath>

namespace tessera::builtin
{

static constexpr CubeAtlas kAtlas = { 640, 16 };

// What the noise says about a place on the unit sphere.
struct Place
{
	float land = 0;    // signed: below 0 is sea, -1 deep
	float height = 0;  // 0 at sea level
};

static Place placeAt(vec3 p)
{
	// Continents: noise looked up at places pushed about by noise, so that coasts have bays and arms.
	const vec3 push = { fractalNoise(p * 2.1f, 2, 11), fractalNoise(p * 2.1f, 2, 22), fractalNoise(p * 2.1f, 2, 33) };
	const vec3 q = p + 0.22f * push;
	const float land = fractalNoise(q * 1.9f + vec3(5.1f, 1.9f, 0.4f), 7, 44) + 0.035f;
	if (land <= 0)
		return { land, 0 };

	// Ranges rise in long belts, along the zero lines of a noise, and fade toward the coast; hills everywhere else.
	const float line = gradientNoise(q * 1.7f, 55) + 0.25f * gradientNoise(q * 4.3f, 56);
	const float belt = smoothStep(0.30f, 0.02f, line < 0 ? -line : line) * smoothStep(0.0f, 0.16f, land);
	const float crests = ridgedNoise(q * 4.6f, 7, 66);
	const float hills = 0.5f + 0.5f * fractalNoise(p * 13.0f, 4, 77);
	const float shelf = 0.035f * smoothStep(0.0f, 0.02f, land);
	const float inland = smoothStep(0.0f, 0.12f, land);
	return { land, shelf + inland * (0.07f * hills + 0.10f * land) + belt * (0.12f + 0.95f * crests) + 0.06f * inland * crests };
}

// How cold: 0 at the equator at sea level, 1 and more where ice lies. Exact only where it can reach `least`.
static float coldness(vec3 p, float height, float least)
{
	const float latitude = p.y < 0 ? -p.y : p.y;
	const float even = smoothStep(0.62f, 0.98f, latitude) * 1.05f + 0.95f * height;
	return even + 0.30f < least ? even : even + 0.22f * fractalNoise(p * 6.0f, 5, 88);
}

static vec3 seaColor(vec3 p, float land)
{
	const float shallow = smoothStep(-0.16f, 0.0f, land);
	vec3 color = glm::mix(vec3(0.035f, 0.115f, 0.26f), vec3(0.10f, 0.36f, 0.50f), shallow * shallow);
	color = glm::mix(color, vec3(0.40f, 0.67f, 0.66f), smoothStep(-0.022f, 0.0f, land));
	const float ice = smoothStep(0.86f, 0.90f, coldness(p, 0, 0.86f));
	return glm::mix(color, vec3(0.82f, 0.88f, 0.92f), ice);
}

static vec3 landColor(vec3 p, const Place& place, float steepness)
{
	const float latitude = p.y < 0 ? -p.y : p.y;
	const float mottle = fractalNoise(p * 23.0f, 3, 99);
	const float dry = smoothStep(0.05f, 0.38f, fractalNoise(p * 2.1f, 3, 111) + 0.42f - 1.1f * latitude);
	vec3 color = glm::mix(vec3(0.22f, 0.38f, 0.14f), vec3(0.13f, 0.29f, 0.12f), smoothStep(-0.3f, 0.4f, mottle));
	color = glm::mix(color, vec3(0.76f, 0.62f, 0.40f) + 0.08f * mottle, dry);
	color = glm::mix(color, vec3(0.42f, 0.40f, 0.30f), smoothStep(0.45f, 0.75f, latitude + 0.1f * mottle) * 0.8f);

	// Sand along the coast, bare rock where it is high or steep, snow where it is cold and not too steep.
	color = glm::mix(vec3(0.82f, 0.74f, 0.54f), color, smoothStep(0.004f, 0.020f, place.land));
	const vec3 rock = glm::mix(vec3(0.36f, 0.31f, 0.28f), vec3(0.50f, 0.45f, 0.40f), 0.5f + mottle);
	color = glm::mix(color, rock, std::max(smoothStep(0.34f, 0.58f, place.height + 0.08f * mottle), smoothStep(1.3f, 2.8f, steepness)));
	const float snow = smoothStep(0.66f, 0.80f, coldness(p, place.height, 0.66f) - 0.05f * steepness);
	return glm::mix(color, vec3(0.89f, 0.92f, 0.95f), snow);
}

uint32_t addPlanetMesh(ImportedScene& scene)
{
	std::vector<Place> places(size_t(kAtlas.width()) * kAtlas.height());
	HeightField heights(kAtlas.width(), kAtlas.height());
	forEachTexel(heights.width, heights.height, [&](uint32_t x, uint32_t y) {
		Place& place = places[size_t(y) * heights.width + x];
		place = placeAt(kAtlas.direction(x, y));
		heights.at(x, y) = place.height;
	});
	Image color = colorImage("planet color", heights.width, heights.height, [&](uint32_t x, uint32_t y) {
		const vec3 p = kAtlas.direction(x, y);
		const Place& place = places[size_t(y) * heights.width + x];
		if (place.land <= 0)
			return seaColor(p, place.land);
		const vec2 slope = heights.slope(x, y, false) / kAtlas.texelLength();
		return landColor(p, place, 0.35f * std::sqrt(glm::dot(slope, slope)));
	});
	heights.normalize();
	const uint32_t color_texture = addTexture(scene, std::move(color), Wrap::ClampToEdge, Wrap::ClampToEdge);
	const uint32_t height_texture = addTexture(scene, heightImage("planet height", heights), Wrap::ClampToEdge, Wrap::ClampToEdge);
	scene.materials.push_back(displacedMaterial("planet", color_texture, height_texture, 0.09f, 0, 0.75f));
	Primitive sphere = cubeSphere(20, kAtlas);
	sphere.material = uint32_t(scene.materials.size() - 1);
	return addMesh(scene, "planet", { std::move(sphere) });
}

ImportedScene makePlanet(uint32_t)
{
	ImportedScene scene;
	scene.instances.push_back({ addPlanetMesh(scene), dmat4(1) });
	scene.cameras.push_back(lookAtCamera({ 0.95, 0.85, 2.55 }, { 0, 0, 0 }, 47));
	return scene;
}

}  // namespace tessera::builtin
