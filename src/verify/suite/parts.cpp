#include "verify/suite/parts.h"

#include "scene/builtin/noise.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tessera::verify::parts
{

Image heights(uint32_t width, uint32_t height, TexelFormat format, const std::function<float(uint32_t, uint32_t)>& value)
{
	Image image = { "heights", width, height, 1, format, {} };
	const size_t size = format == TexelFormat::U8 ? 1 : format == TexelFormat::U16 ? 2 : 4;
	image.texels.resize(size_t(width) * height * size);
	for (uint32_t y = 0; y < height; ++y)
		for (uint32_t x = 0; x < width; ++x)
		{
			std::byte* texel = &image.texels[(size_t(y) * width + x) * size];
			const float h = value(x, y);
			const auto coded = [&](float most) {
				return uint16_t(std::lround(std::clamp(h, 0.0f, 1.0f) * most));
			};
			if (format == TexelFormat::F32)
				std::memcpy(texel, &h, 4);
			else if (format == TexelFormat::U16)
			{
				const uint16_t bits = coded(65535);
				std::memcpy(texel, &bits, 2);
			}
			else
				*texel = static_cast<std::byte>(coded(255));
		}
	return image;
}

Image noise(uint32_t width, uint32_t height, TexelFormat format, uint32_t seed)
{
	return heights(width, height, format, [&](uint32_t x, uint32_t y) {
		return builtin::unitFloat(builtin::hashLattice({ int(x), int(y), 0 }, seed));
	});
}

uint32_t addPlain(ImportedScene& scene)
{
	scene.materials.push_back({ .name = "plain", .metallic = 0 });
	return uint32_t(scene.materials.size() - 1);
}

uint32_t addDisplaced(ImportedScene& scene, Image image, float factor, float offset, Wrap wrap)
{
	const uint32_t material = addPlain(scene);
	scene.materials[material].displacement = Displacement{ TextureUse{ builtin::addTexture(scene, std::move(image), wrap, wrap) }, factor, offset };
	return material;
}

uint32_t addPlaced(ImportedScene& scene, Primitive primitive, const dmat4& world)
{
	const uint32_t mesh = builtin::addMesh(scene, "mesh", { std::move(primitive) });
	scene.instances.push_back({ mesh, world });
	return mesh;
}

namespace
{

// Noise whose neighbouring texels are alike, on an atlas of cube faces: heights do not match across seams.
Image bumps(const builtin::CubeAtlas& atlas)
{
	return heights(atlas.width(), atlas.height(), TexelFormat::U16,
				   [&](uint32_t x, uint32_t y) { return 0.5f + 0.25f * std::sin(float(x) * 0.37f) + 0.25f * std::cos(float(y) * 0.29f); });
}

ImportedScene ballWith(uint32_t n, const builtin::CubeAtlas& atlas, Image image, float radius, float factor, float offset, vec3 centre)
{
	ImportedScene scene;
	Primitive sphere = builtin::cubeSphere(n, atlas);
	for (vec3& p : sphere.positions)
		p = p * radius + centre;
	sphere.material = addDisplaced(scene, std::move(image), factor, offset);
	addPlaced(scene, std::move(sphere));
	return scene;
}

constexpr builtin::CubeAtlas kAtlas = { 32, 2 };

}  // namespace

ImportedScene ball(uint32_t n, float radius, float factor, vec3 centre)
{
	return ballWith(n, kAtlas, bumps(kAtlas), radius, factor, 0, centre);
}

ImportedScene ball(uint32_t n, Image image, float factor, float offset)
{
	return ballWith(n, kAtlas, std::move(image), 1, factor, offset, vec3(0));
}

ImportedScene sheet(uint32_t nx, uint32_t ny, float factor)
{
	ImportedScene scene;
	Primitive quads;
	builtin::addGrid(quads, { -1, -1, 0 }, { 2, 0, 0 }, { 0, 2, 0 }, nx, ny, { 0, 1 }, { 1, 0 });
	quads.material = addDisplaced(scene, noise(16, 16, TexelFormat::U8, 1), factor);
	addPlaced(scene, std::move(quads));
	return scene;
}

Camera lookingAt(dvec3 eye, dvec3 target, double fov_deg, double near_world)
{
	Camera camera;
	camera.eye = eye;
	camera.target = target;
	camera.fov_y_rad = fov_deg * (3.14159265358979323846 / 180);
	camera.near_world = near_world;
	const dvec3 forward = glm::normalize(target - eye);
	camera.up = std::abs(forward.y) > 0.99 ? dvec3(0, 0, -1) : dvec3(0, 1, 0);
	return camera;
}

std::function<void(std::vector<std::byte>&)> replacing(float marker, float value)
{
	return [marker, value](std::vector<std::byte>& file) {
		for (size_t i = 0; i + 4 <= file.size(); ++i)
			if (std::memcmp(&file[i], &marker, 4) == 0)
				std::memcpy(&file[i], &value, 4);
	};
}

}  // namespace tessera::verify::parts
