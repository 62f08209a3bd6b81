// Strips and fans into triangle lists.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera
{

// glTF primitive modes that have triangles.
enum GltfMode : int
{
	kGltfTriangles = 4,
	kGltfTriangleStrip = 5,
	kGltfTriangleFan = 6,
};

// `indices` in the order of `mode` (4, 5 or 6) as a triangle list with the winding that glTF gives each triangle.
// n indices give n / 3 triangles of a list and n - 2 of a strip or fan (none below 3); degenerate ones are kept.
std::vector<uint32_t> triangleList(int mode, std::vector<uint32_t> indices);

}  // namespace tessera
