// Small scenes for tests and first looks.
#include "scene/builtin/bricks.h"
#include "scene/builtin/noise.h"
#include "scene/builtin/parts.h"
#include "scene/builtin/scenes.h"

namespace tessera::builtin
{

// A tileable map of soft hills with its colours, as a material; heights over [0, factor].
static uint32_t addHillMaterial(ImportedScene& scene, uint32_t size, float factor)
{
	HeightField heights(size, size);
	forEachTexel(size, size,
				 [&](uint32_t x, uint32_t y) { heights.at(x, y) = tileableNoise(vec2(float(x) + 0.5f, float(y) + 0.5f) / float(size), 5, 5, 3); });
	heights.normalize();
	Image color = colorImage("hills color", size, size, [&](uint32_t x, uint32_t y) {
		return glm::mix(vec3(0.16f, 0.27f, 0.36f), vec3(0.88f, 0.80f, 0.62f), smoothStep(0.15f, 0.85f, heights.at(x, y)));
	});
	const uint32_t color_texture = addTexture(scene, std::move(color), Wrap::Repeat, Wrap::Repeat);
	const uint32_t height_texture = addTexture(scene, heightImage("hills height", heights), Wrap::Repeat, Wrap::Repeat);
	scene.materials.push_back(displacedMaterial("hills", color_texture, height_texture, factor, 0, 0.7f));
	return uint32_t(scene.materials.size() - 1);
}

ImportedScene makeQuad(uint32_t)
{
	ImportedScene scene;
	Primitive quad;
	addGrid(quad, { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 }, 1, 1, { 0, 1 }, { 1, 0 });
	quad.material = addHillMaterial(scene, 256, 0.25f);
	scene.instances.push_back({ addMesh(scene, "quad", { std::move(quad) }), dmat4(1) });
	scene.cameras.push_back(lookAtCamera({ 0.9, -1.6, 2.3 }, { 0, -0.1, 0 }, 45));
	return scene;
}

ImportedScene makeCube(uint32_t)
{
	// Each side: corner, way along u, way along v (upward in the map).
	static constexpr vec3 kSides[6][3] = {
		{ { -1, -1, 1 }, { 2, 0, 0 }, { 0, 2, 0 } },  { { 1, -1, -1 }, { -2, 0, 0 }, { 0, 2, 0 } }, { { 1, -1, 1 }, { 0, 0, -2 }, { 0, 2, 0 } },
		{ { -1, -1, -1 }, { 0, 0, 2 }, { 0, 2, 0 } }, { { -1, 1, 1 }, { 2, 0, 0 }, { 0, 0, -2 } },  { { -1, -1, -1 }, { 2, 0, 0 }, { 0, 0, 2 } },
	};
	ImportedScene scene;
	Primitive cube;
	// A different stretch of the map on every side: heights differ across each edge until one side owns it.
	for (int side = 0; side < 6; ++side)
	{
		const vec2 shift = 0.3125f * vec2(float(side % 3), float(side / 3));
		addGrid(cube, kSides[side][0], kSides[side][1], kSides[side][2], 2, 2, shift + vec2(0, 1), shift + vec2(1, 0));
	}
	cube.material = addHillMaterial(scene, 512, 0.3f);
	scene.instances.push_back({ addMesh(scene, "cube", { std::move(cube) }), dmat4(1) });
	scene.cameras.push_back(lookAtCamera({ 2.6, 2.2, 4.2 }, { 0, 0, 0 }, 42));
	return scene;
}

ImportedScene makeMaterials(uint32_t)
{
	ImportedScene scene;
	std::vector<Primitive> halves(2);
	addGrid(halves[0], { -2, 0, 1.5f }, { 2, 0, 0 }, { 0, 0, -3 }, 4, 6, { 0, 1.5f }, { 1, 0 });
	addGrid(halves[1], { 0, 0, 1.5f }, { 2, 0, 0 }, { 0, 0, -3 }, 4, 6, { 0, 1.5f }, { 1, 0 });
	halves[0].material = addBrickMaterial(scene, 512, 0.10f, 0);
	halves[1].material = addCobbleMaterial(scene, 512, 0.20f, -0.05f);
	scene.instances.push_back({ addMesh(scene, "two materials", std::move(halves)), dmat4(1) });
	scene.cameras.push_back(lookAtCamera({ 0.6, 2.0, 3.4 }, { 0, 0, 0 }, 42));
	return scene;
}

}  // namespace tessera::builtin
