// What the suite's scenes are made of.
#pragma once
#include "scene/builtin/parts.h"
#include "verify/cameras.h"

#include <functional>

namespace tessera::verify::parts
{

// Heights from a function of the texel, as an image of one channel; U8 and U16 clamp to 0..1.
Image heights(uint32_t width, uint32_t height, TexelFormat format, const std::function<float(uint32_t x, uint32_t y)>& value);

// Unrelated neighbours, so that a wrong coordinate shows.
Image noise(uint32_t width, uint32_t height, TexelFormat format, uint32_t seed);

// A material displaced by an image; returns its index.
uint32_t addDisplaced(ImportedScene& scene, Image image, float factor, float offset = 0, Wrap wrap = Wrap::Repeat);
uint32_t addPlain(ImportedScene& scene);

// A mesh of one primitive; returns its index. `world` places it; nullptr: nowhere yet.
uint32_t addPlaced(ImportedScene& scene, Primitive primitive, const dmat4& world = dmat4(1));

// A closed displaced ball of 12 n^2 triangles around `centre`, with seams between its six charts.
ImportedScene ball(uint32_t n, float radius = 1, float factor = 0.1f, vec3 centre = vec3(0));
// The same, displaced by another image.
ImportedScene ball(uint32_t n, Image image, float factor, float offset = 0);

// A square of side 2 in the plane z = 0, nx by ny quads, displaced.
ImportedScene sheet(uint32_t nx, uint32_t ny, float factor = 0.1f);

Camera lookingAt(dvec3 eye, dvec3 target, double fov_deg, double near_world = 0);

// Writes a float over every occurrence of another, bit by bit: NaN and infinity cannot be put into a file that is checked.
std::function<void(std::vector<std::byte>&)> replacing(float marker, float value);
constexpr float kMarker = 0x1.fedcbap-3f;

}  // namespace tessera::verify::parts
