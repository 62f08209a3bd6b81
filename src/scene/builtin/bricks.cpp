#include "scene/builtin/bricks.h"

#include "scene/builtin/noise.h"
#include "scene/builtin/parts.h"

#include <algorithm>
#include <cmath>

namespace tessera::builtin
{

static uint32_t addMaps(ImportedScene& scene, std::string name, HeightField& heights, Image color, float factor, float offset)
{
	heights.normalize();
	const uint32_t color_texture = addTexture(scene, std::move(color), Wrap::Repeat, Wrap::Repeat);
	const uint32_t height_texture = addTexture(scene, heightImage(name + " height", heights), Wrap::Repeat, Wrap::Repeat);
	scene.materials.push_back(displacedMaterial(std::move(name), color_texture, height_texture, factor, offset, 0.85f));
	return uint32_t(scene.materials.size() - 1);
}

static vec2 texelCenter(uint32_t x, uint32_t y, uint32_t size)
{
	return vec2(float(x) + 0.5f, float(y) + 0.5f) / float(size);
}

// --- bricks -----------------------------------------------------------------------------------------------------------------------

// The brick that a place lies on. Lengths are in course heights: a brick's cell is 3 x 1.
struct BrickPlace
{
	uint32_t hash = 0;      // of the brick
	vec2 from_middle = {};  // of the brick's cell
	float inside = 0;       // how far inside the brick's outline; negative in the mortar
};

static BrickPlace brickPlace(vec2 uv)
{
	const float course = uv.y * float(kCourses);
	const int row = floorToInt(course);
	const float along = uv.x * float(kBricksAcross) + (row % 2 == 1 ? 0.5f : 0.0f);
	const int column = floorToInt(along);
	BrickPlace place;
	place.hash = hashLattice({ column % int(kBricksAcross), row, 0 }, 7);
	place.from_middle = { (along - float(column) - 0.5f) * 3.0f, course - float(row) - 0.5f };

	// A rounded rectangle with a worn outline and chipped edges.
	const float worn = 0.035f * tileableNoise(uv, 48, 3, 21);
	const float chips = 0.14f * smoothStep(0.22f, 0.52f, tileableNoise(uv, 27, 2, 22));
	const float gap = 0.055f + 0.025f * unitFloat(mixBits(place.hash + 1));
	constexpr float kRound = 0.07f;
	const vec2 size = vec2(1.5f, 0.5f) - gap - kRound;
	const vec2 beyond = glm::max(place.from_middle, -place.from_middle) - size;
	const vec2 outside = glm::max(beyond, vec2(0));
	const float distance = std::sqrt(glm::dot(outside, outside)) + std::min(std::max(beyond.x, beyond.y), 0.0f) - kRound;
	place.inside = -distance - chips + worn;
	return place;
}

static float brickHeight(vec2 uv, const BrickPlace& place)
{
	const float sand = tileableNoise(uv, 200, 3, 23);
	const float mortar = 0.16f + 0.10f * sand + 0.05f * tileableNoise(uv, 18, 3, 24);
	const vec2 tilt = vec2(unitFloat(mixBits(place.hash + 2)), unitFloat(mixBits(place.hash + 3))) - 0.5f;
	const float skin = 0.07f * tileableNoise(uv, 36, 5, 25) + 0.02f * sand;
	const float pits = 0.10f * smoothStep(0.30f, 0.55f, tileableNoise(uv, 90, 2, 26));
	const float proud = 0.16f * unitFloat(mixBits(place.hash + 4));
	const float brick = 0.74f + proud + 0.10f * tilt.x * place.from_middle.x + 0.12f * tilt.y * place.from_middle.y + skin - pits;
	const float bevel = glm::clamp(place.inside / 0.085f, 0.0f, 1.0f);
	return mortar + (brick - mortar) * bevel * (2.0f - bevel);
}

static vec3 brickColor(vec2 uv, const BrickPlace& place)
{
	const float which = unitFloat(mixBits(place.hash + 5)), shade = unitFloat(mixBits(place.hash + 6));
	const float grain = tileableNoise(uv, 60, 5, 27);
	vec3 clay = glm::mix(vec3(0.60f, 0.33f, 0.25f), vec3(0.47f, 0.25f, 0.20f), shade);
	if (which < 0.22f)
		clay = glm::mix(vec3(0.69f, 0.46f, 0.33f), vec3(0.64f, 0.40f, 0.29f), shade);
	else if (which < 0.36f)
		clay = glm::mix(vec3(0.34f, 0.23f, 0.21f), vec3(0.41f, 0.27f, 0.23f), shade);
	clay += 0.13f * grain;
	const vec3 mortar = vec3(0.66f, 0.62f, 0.55f) + 0.12f * tileableNoise(uv, 150, 3, 28);
	return glm::mix(mortar, clay, smoothStep(-0.01f, 0.03f, place.inside));
}

uint32_t addBrickMaterial(ImportedScene& scene, uint32_t size, float factor, float offset)
{
	HeightField heights(size, size);
	Image color = colorImage("bricks color", size, size, [&](uint32_t x, uint32_t y) {
		const vec2 uv = texelCenter(x, y, size);
		const BrickPlace place = brickPlace(uv);
		heights.at(x, y) = brickHeight(uv, place);
		return brickColor(uv, place);
	});
	return addMaps(scene, "bricks", heights, std::move(color), factor, offset);
}

// --- cobblestones -----------------------------------------------------------------------------------------------------------------

uint32_t addCobbleMaterial(ImportedScene& scene, uint32_t size, float factor, float offset)
{
	HeightField heights(size, size);
	Image color = colorImage("cobbles color", size, size, [&](uint32_t x, uint32_t y) {
		const vec2 uv = texelCenter(x, y, size);
		const vec2 pushed = uv + 0.012f * vec2(tileableNoise(uv, 16, 3, 41), tileableNoise(uv, 16, 3, 42));
		const CellPoint cell = tileableCells(pushed, 11, 43);
		const float dome = glm::clamp((cell.border - 0.035f) / 0.30f, 0.0f, 1.0f);
		const float sand = tileableNoise(uv, 170, 3, 44), skin = tileableNoise(uv, 30, 5, 45);
		const vec2 tilt = vec2(unitFloat(mixBits(cell.cell_hash + 1)), unitFloat(mixBits(cell.cell_hash + 2))) - 0.5f;
		const float top = 0.62f + 0.25f * unitFloat(mixBits(cell.cell_hash + 3)) + 0.25f * glm::dot(tilt, cell.offset) + 0.07f * skin;
		const float joint = 0.12f + 0.08f * sand;
		heights.at(x, y) = joint + (top - joint) * std::sqrt(dome * (2.0f - dome));

		const float shade = unitFloat(mixBits(cell.cell_hash + 4)), warm = unitFloat(mixBits(cell.cell_hash + 5));
		const vec3 stone = glm::mix(vec3(0.40f, 0.41f, 0.43f), vec3(0.58f, 0.54f, 0.49f), warm) * (0.75f + 0.4f * shade) + 0.14f * skin;
		const vec3 soil = vec3(0.27f, 0.25f, 0.20f) + 0.10f * sand;
		return glm::mix(soil, stone, smoothStep(0.0f, 0.18f, dome));
	});
	return addMaps(scene, "cobbles", heights, std::move(color), factor, offset);
}

}  // namespace tessera::builtin
