#include "scene/builtin/parts.h"

#include "base/check.h"
#include "base/parallel.h"
#include "scene/builtin/noise.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tessera::builtin
{

void HeightField::normalize()
{
	const auto [low, high] = std::minmax_element(values.begin(), values.end());
	const float base = *low, range = *high - *low;
	CHECK(range > 0, "a flat height map has no range");
	for (float& value : values)
		value = (value - base) / range;
}

vec2 HeightField::slope(uint32_t x, uint32_t y, bool wraps) const
{
	const uint32_t left = x > 0 ? x - 1 : (wraps ? width - 1 : 0), right = x + 1 < width ? x + 1 : (wraps ? 0 : x);
	const uint32_t up = y > 0 ? y - 1 : (wraps ? height - 1 : 0), down = y + 1 < height ? y + 1 : (wraps ? 0 : y);
	return 0.5f * vec2(at(right, y) - at(left, y), at(x, down) - at(x, up));
}

void forEachTexel(uint32_t width, uint32_t height, const std::function<void(uint32_t, uint32_t)>& body)
{
	parallelFor(height, [&](size_t y) {
		for (uint32_t x = 0; x < width; ++x)
			body(x, uint32_t(y));
	});
}

Image heightImage(std::string name, const HeightField& field)
{
	Image image = { std::move(name), field.width, field.height, 1, TexelFormat::U16, {} };
	image.texels.resize(field.values.size() * 2);
	for (size_t i = 0; i < field.values.size(); ++i)
	{
		const uint16_t texel = uint16_t(glm::clamp(field.values[i], 0.0f, 1.0f) * 65535.0f + 0.5f);
		std::memcpy(&image.texels[2 * i], &texel, 2);
	}
	return image;
}

Image colorImage(std::string name, uint32_t width, uint32_t height, const std::function<vec3(uint32_t, uint32_t)>& color)
{
	Image image = { std::move(name), width, height, 3, TexelFormat::U8, {} };
	image.texels.resize(size_t(width) * height * 3);
	forEachTexel(width, height, [&](uint32_t x, uint32_t y) {
		const vec3 value = glm::clamp(color(x, y), vec3(0), vec3(1)) * 255.0f + 0.5f;
		std::byte* texel = &image.texels[(size_t(y) * width + x) * 3];
		for (int c = 0; c < 3; ++c)
			texel[c] = std::byte(uint8_t(value[c]));
	});
	return image;
}

// --- cube sphere -----------------------------------------------------------------------------------------------------------------

struct CubeFace
{
	vec3 right, up, out;  // right x up = out
};

static constexpr CubeFace kFaces[6] = {
	{ { 0, 0, -1 }, { 0, 1, 0 }, { 1, 0, 0 } }, { { 0, 0, 1 }, { 0, 1, 0 }, { -1, 0, 0 } }, { { 1, 0, 0 }, { 0, 0, -1 }, { 0, 1, 0 } },
	{ { 1, 0, 0 }, { 0, 0, 1 }, { 0, -1, 0 } }, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },  { { -1, 0, 0 }, { 0, 1, 0 }, { 0, 0, -1 } },
};

// Spreads points evenly in angle (close to tan(pi/4 s)); odd, and exactly 1 at 1, so that neighbouring faces meet to the bit.
static float evenAngle(float s)
{
	return s * (0.75f + 0.25f * (s * s));
}

// The direction at (s, t) of a face, both within [-1, 1] (a little more in the gutter).
static vec3 faceDirection(const CubeFace& face, float s, float t)
{
	const vec3 p = face.out + face.right * evenAngle(s) + face.up * evenAngle(t) + vec3(0.0f);
	return p / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

vec3 CubeAtlas::direction(uint32_t x, uint32_t y) const
{
	const CubeFace& face = kFaces[y / cell * 3 + x / cell];
	const float inner = float(cell - 2 * gutter);
	const float s = (float(x % cell) + 0.5f - float(gutter)) / inner * 2.0f - 1.0f;
	const float t = 1.0f - (float(y % cell) + 0.5f - float(gutter)) / inner * 2.0f;
	return faceDirection(face, s, t);
}

float CubeAtlas::texelLength() const
{
	return 1.5f / float(cell - 2 * gutter);
}

static void addQuadIndices(Primitive& primitive, uint32_t first, uint32_t nx, uint32_t ny)
{
	for (uint32_t j = 0; j < ny; ++j)
		for (uint32_t i = 0; i < nx; ++i)
		{
			const uint32_t a = first + j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
			// Diagonals alternate, so that no direction is favoured.
			const bool falling = (i + j) % 2 == 1;
			for (const uint32_t index : falling ? std::array{ a, b, d, b, c, d } : std::array{ a, b, c, a, c, d })
				primitive.indices.push_back(index);
		}
}

Primitive cubeSphere(uint32_t n, const CubeAtlas& atlas)
{
	Primitive sphere;
	sphere.texcoords.resize(1);
	const float inner = float(atlas.cell - 2 * atlas.gutter);
	for (uint32_t f = 0; f < 6; ++f)
	{
		const uint32_t first = uint32_t(sphere.positions.size());
		const vec2 corner = { float(f % 3 * atlas.cell + atlas.gutter), float(f / 3 * atlas.cell + atlas.gutter) };
		for (uint32_t j = 0; j <= n; ++j)
			for (uint32_t i = 0; i <= n; ++i)
			{
				const float s = float(int(2 * i) - int(n)) / float(n), t = float(int(2 * j) - int(n)) / float(n);
				const vec3 direction = faceDirection(kFaces[f], s, t);
				const vec2 texel = corner + inner * vec2(float(i) / float(n), float(n - j) / float(n));
				sphere.positions.push_back(direction);
				sphere.normals.push_back(direction);
				sphere.texcoords[0].push_back(texel / vec2(float(atlas.width()), float(atlas.height())));
			}
		addQuadIndices(sphere, first, n, n);
	}
	return sphere;
}

// --- flat parts ------------------------------------------------------------------------------------------------------------------

void addGrid(Primitive& primitive, vec3 origin, vec3 along_x, vec3 along_y, uint32_t nx, uint32_t ny, vec2 uv0, vec2 uv1)
{
	primitive.texcoords.resize(std::max<size_t>(1, primitive.texcoords.size()));
	const uint32_t first = uint32_t(primitive.positions.size());
	const vec3 across = glm::cross(along_x, along_y);
	const vec3 normal = across / std::sqrt(glm::dot(across, across)) + vec3(0.0f);
	for (uint32_t j = 0; j <= ny; ++j)
		for (uint32_t i = 0; i <= nx; ++i)
		{
			const float x = float(i) / float(nx), y = float(j) / float(ny);
			primitive.positions.push_back(origin + along_x * x + along_y * y + vec3(0.0f));
			primitive.normals.push_back(normal);
			primitive.texcoords[0].push_back(uv0 + (uv1 - uv0) * vec2(x, y));
		}
	addQuadIndices(primitive, first, nx, ny);
}

// --- scene ------------------------------------------------------------------------------------------------------------------------

uint32_t addTexture(ImportedScene& scene, Image image, Wrap wrap_u, Wrap wrap_v)
{
	scene.images.push_back(std::move(image));
	scene.textures.push_back({ uint32_t(scene.images.size() - 1), wrap_u, wrap_v, false });
	return uint32_t(scene.textures.size() - 1);
}

Material displacedMaterial(std::string name, uint32_t color_texture, uint32_t height_texture, float factor, float offset, float roughness)
{
	Material material;
	material.name = std::move(name);
	material.base_color_texture = TextureUse{ color_texture };
	material.metallic = 0;
	material.roughness = roughness;
	material.displacement = Displacement{ TextureUse{ height_texture }, factor, offset };
	return material;
}

uint32_t addMesh(ImportedScene& scene, std::string name, std::vector<Primitive> primitives)
{
	scene.meshes.push_back({ std::move(name), std::move(primitives) });
	return uint32_t(scene.meshes.size() - 1);
}

FileCamera lookAtCamera(dvec3 eye, dvec3 target, double fov_degrees)
{
	const dvec3 back = glm::normalize(eye - target);
	const dvec3 right = glm::normalize(glm::cross(dvec3(0, 1, 0), back));
	const dvec3 up = glm::cross(back, right);
	FileCamera camera;
	camera.name = "overview";
	camera.world = dmat4(dvec4(right, 0), dvec4(up, 0), dvec4(back, 0), dvec4(eye, 1));
	camera.fov_y_rad = fov_degrees * (3.141592653589793 / 180);
	camera.near_world = 0.01;
	return camera;
}

dmat4 rotation(dvec3 axis, double turns)
{
	const double s = sineOfTurns(turns), c = cosineOfTurns(turns);
	const dvec3 t = axis * (1 - c);
	return dmat4(dvec4(c + t.x * axis.x, t.x * axis.y + s * axis.z, t.x * axis.z - s * axis.y, 0),
				 dvec4(t.x * axis.y - s * axis.z, c + t.y * axis.y, t.y * axis.z + s * axis.x, 0),
				 dvec4(t.x * axis.z + s * axis.y, t.y * axis.z - s * axis.x, c + t.z * axis.z, 0), dvec4(0, 0, 0, 1));
}

}  // namespace tessera::builtin
