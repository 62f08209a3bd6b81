// Meshes as PLY files, binary little endian: what most tools for scanning, printing and simulation read.
#pragma once
#include "base/result.h"
#include "base/vec.h"

#include <cstdint>
#include <filesystem>
#include <span>

namespace tessera
{

// An indexed triangle mesh to write. Optional arrays are empty or as long as positions.
struct MeshView
{
	std::span<const vec3> positions;
	std::span<const vec3> normals;      // optional
	std::span<const vec2> uvs;          // optional; v runs down, as in glTF
	std::span<const uint32_t> indices;  // 3 per triangle, each < positions.size(), counter-clockwise front
};

// Writes x y z, nx ny nz, s t (v turned to run up, as PLY's tools expect) and faces of three uint indices.
// An index out of range or an array of the wrong length is our bug and fails a CHECK.
// Errors: BadInput (path and reason; more than 2^31 - 1 vertices or triangles); no partial file is left.
Status writePly(const std::filesystem::path& path, const MeshView& mesh);

// CHECKs the promises of MeshView.
void checkMesh(const MeshView& mesh);

}  // namespace tessera
