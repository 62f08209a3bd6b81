// The planet: continents from warped noise, ridged mountains on them, ice by latitude and height.
#include "scene/builtin_noise.h"
#include "scene/builtin_parts.h"
#include "scene/builtin_scenes.h"

#include <algorithm>
#include <cmath>

namespace tessera::builtin
{

static constexpr CubeAtlas kAtlas = { 768, 16 };

// What the noise says about a place on the unit sphere.
struct Place
{
	float land = 0;   // signed: below 0 is sea, -1 deep
	float height = 0; // 0 at sea level
};

static Place placeAt(vec3 p)
{
	// Continents: noise looked up at places pushed about by noise, so that coasts have bays and arms.
	const vec3 push = { fractalNoise(p * 1.6f, 3, 11), fractalNoise(p * 1.6f, 3, 22), fractalNoise(p * 1.6f, 3, 33) };
	const vec3 q = p + 0.45f * push;
	const float land = fractalNoise(q * 1.5f + vec3(4.1f, 0.7f, 2.3f), 6, 44) + 0.10f;
	if (land <= 0)
		return { land, 0 };

	// Ranges rise in belts away from the coast; hills everywhere else.
	const float inland = smoothStep(0.0f, 0.22f, land);
	const float belt = smoothStep(-0.12f, 0.30f, gradientNoise(q * 2.3f, 55));
	const float crests = ridgedNoise(q * 3.4f, 7, 66);
	const float hills = 0.5f + 0.5f * fractalNoise(q * 9.0f, 5, 77);
	const float shelf = 0.05f * smoothStep(0.0f, 0.03f, land);
	return { land, shelf + inland * (0.10f * hills + 0.12f * land + belt * crests * 1.05f) };
}

// How cold: 0 at the equator at sea level, 1 and more where ice lies.
static float coldness(vec3 p, float height)
{
	const float latitude = p.y < 0 ? -p.y : p.y;
	return smoothStep(0.62f, 0.98f, latitude) * 1.05f + 0.95f * height + 0.10f * fractalNoise(p * 5.0f, 3, 88);
}

static vec3 seaColor(vec3 p, float land)
{
	const float shallow = smoothStep(-0.16f, 0.0f, land);
	vec3 color = glm::mix(vec3(0.035f, 0.115f, 0.26f), vec3(0.10f, 0.36f, 0.50f), shallow * shallow);
	color = glm::mix(color, vec3(0.40f, 0.67f, 0.66f), smoothStep(-0.022f, 0.0f, land));
	const float ice = smoothStep(0.88f, 0.94f, coldness(p, 0));
	return glm::mix(color, vec3(0.86f, 0.91f, 0.95f), ice);
}

static vec3 landColor(vec3 p, const Place& place, float steepness)
{
	const float latitude = p.y < 0 ? -p.y : p.y;
	const float mottle = fractalNoise(p * 14.0f, 4, 99);
	const float dry = smoothStep(0.05f, 0.38f, fractalNoise(p * 2.1f, 3, 111) + 0.42f - 1.1f * latitude);
	vec3 color = glm::mix(vec3(0.22f, 0.38f, 0.14f), vec3(0.13f, 0.29f, 0.12f), smoothStep(-0.3f, 0.4f, mottle));
	color = glm::mix(color, vec3(0.76f, 0.62f, 0.40f) + 0.08f * mottle, dry);
	color = glm::mix(color, vec3(0.42f, 0.40f, 0.30f), smoothStep(0.45f, 0.75f, latitude + 0.1f * mottle) * 0.8f);

	// Sand along the coast, bare rock where it is high or steep, snow where it is cold and not too steep.
	color = glm::mix(vec3(0.82f, 0.74f, 0.54f), color, smoothStep(0.004f, 0.020f, place.land));
	const vec3 rock = glm::mix(vec3(0.39f, 0.33f, 0.29f), vec3(0.52f, 0.47f, 0.42f), 0.5f + mottle);
	color = glm::mix(color, rock, std::max(smoothStep(0.30f, 0.52f, place.height), smoothStep(0.9f, 2.2f, steepness)));
	const float snow = smoothStep(0.66f, 0.80f, coldness(p, place.height) - 0.05f * steepness);
	return glm::mix(color, vec3(0.94f, 0.96f, 0.98f), snow);
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
	scene.cameras.push_back(lookAtCamera({ 0.9, 0.85, 2.35 }, { 0, 0, 0 }, 46));
	return scene;
}

} // namespace tessera::builtin
