// What the built-in scenes share: images from functions, base meshes, materials, cameras.
#pragma once
#include "scene/imported_scene.h"

#include <functional>
#include <string>
#include <vector>

namespace tessera::builtin
{

// Heights of one map, row by row from the top. Any finite values until `normalize`.
struct HeightField
{
	uint32_t width = 0, height = 0;
	std::vector<float> values;  // width * height

	HeightField(uint32_t w, uint32_t h) : width(w), height(h), values(size_t(w) * h) {}
	float& at(uint32_t x, uint32_t y) { return values[size_t(y) * width + x]; }
	float at(uint32_t x, uint32_t y) const { return values[size_t(y) * width + x]; }

	// Moves and scales the values to [0, 1] exactly.
	void normalize();

	// Slope toward +x and +y (down) in height per texel, by central differences; `wraps`: across the map's borders, else clamped.
	vec2 slope(uint32_t x, uint32_t y, bool wraps) const;
};

// Calls body(x, y) for every texel, rows in parallel.
void forEachTexel(uint32_t width, uint32_t height, const std::function<void(uint32_t, uint32_t)>& body);

// Heights in [0, 1] (clamped) as a 16-bit image of one channel.
Image heightImage(std::string name, const HeightField& field);

// An 8-bit RGB image; color(x, y) gives sRGB-coded channels in [0, 1] (clamped).
Image colorImage(std::string name, uint32_t width, uint32_t height, const std::function<vec3(uint32_t, uint32_t)>& color);

// --- cube sphere -----------------------------------------------------------------------------------------------------------------
// Six faces in an atlas of 3 x 2 cells. Each cell has a gutter where the face's map goes on past its edges, so that filtering never
// mixes faces. No poles: texels and triangles are nearly the same size everywhere.

struct CubeAtlas
{
	uint32_t cell = 0;    // texels along a cell, gutters included
	uint32_t gutter = 0;  // texels on each side

	uint32_t width() const { return 3 * cell; }
	uint32_t height() const { return 2 * cell; }

	// Direction (unit length) that the centre of texel (x, y) stands for.
	vec3 direction(uint32_t x, uint32_t y) const;

	// Length of a texel on the unit sphere, in the middle of a face, where texels are smallest.
	float texelLength() const;
};

// Unit sphere of 12 * n * n triangles with outward normals and TEXCOORD_0 in the atlas. Positions along face edges are equal to the bit.
Primitive cubeSphere(uint32_t n, const CubeAtlas& atlas);

// --- flat parts ------------------------------------------------------------------------------------------------------------------

// Adds an nx x ny grid of quads spanned by `origin`, `origin + along_x`, `origin + along_y`; normal along_x x along_y; uv runs from
// uv0 at the origin to uv1 at the far corner. Corner (i, j) is origin + along_x * (i / nx) + along_y * (j / ny).
void addGrid(Primitive& primitive, vec3 origin, vec3 along_x, vec3 along_y, uint32_t nx, uint32_t ny, vec2 uv0, vec2 uv1);

// --- scene ------------------------------------------------------------------------------------------------------------------------

// Appends an image and a texture of it; returns the texture's index.
uint32_t addTexture(ImportedScene& scene, Image image, Wrap wrap_u, Wrap wrap_v);

// A dielectric material with a colour map and a height map; heights run over [offset, offset + factor] mesh units.
Material displacedMaterial(std::string name, uint32_t color_texture, uint32_t height_texture, float factor, float offset, float roughness);

// Appends a mesh of these primitives; returns its index.
uint32_t addMesh(ImportedScene& scene, std::string name, std::vector<Primitive> primitives);

// A perspective camera at `eye` that looks at `target`, +y up; vertical field of view in degrees; near distance 0.01.
FileCamera lookAtCamera(dvec3 eye, dvec3 target, double fov_degrees);

// Turn about a unit axis by `turns`, as a matrix.
dmat4 rotation(dvec3 axis, double turns);

}  // namespace tessera::builtin
