// The distinct vertices of a mesh: one per welded vertex and set of attributes within a primitive.
#pragma once
#include "scene/build/directions.h"
#include "scene/build/material_build.h"

namespace tessera
{

// What tells vertices apart; compared bit by bit. What the scene does not need is 0 everywhere.
struct MeshVertex
{
	vec3 normal = vec3(0);
	vec2 uv = vec2(0);  // for the height map, transform applied; 0 where the primitive is not displaced
	vec2 color_uv = vec2(0);
	uint32_t color = 0xffffffff;
	uint32_t weld = 0;  // within the mesh
};
static_assert(sizeof(MeshVertex) == 36, "compared as bytes: no padding");

struct MeshVertices
{
	std::vector<MeshVertex> vertices;
	std::vector<float> densities;           // parallel; 0 where not displaced
	std::vector<uint32_t> corner_vertices;  // per corner
	std::vector<uint32_t> first_vertices;   // per primitive, and the count of all at the end
	std::vector<uint32_t> height_maps;      // per primitive: map or NO_INDEX
};

// Finds the vertices of a mesh. `materials`: per primitive. `with_colors`: some primitive of the scene has vertex colours.
MeshVertices buildVertices(const Mesh& mesh, const MeshCorners& corners, const MeshWeld& weld, const MeshNormals& normals,
						   const std::vector<uint32_t>& materials, const MaterialUses& uses, const BuiltScene& scene, bool with_colors);

// Fills in densities: height texels per mesh unit at a welded vertex. The root of texel area over surface area, both summed over the
// triangles of the fan that use the map and have both areas; 0 (finest mip) where there is none. Equal in bits for all vertices of
// one welded vertex and map.
void buildDensities(const MeshCorners& corners, const MeshWeld& weld, const std::vector<HeightMapData>& maps, MeshVertices& vertices);

// A texture coordinate through KHR_texture_transform: in double, rounded once, cleaned (cleanFloat).
vec2 transformUv(const TextureUse& use, vec2 uv);

}  // namespace tessera
