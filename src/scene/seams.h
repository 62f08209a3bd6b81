// Seams: where triangles that meet would read different heights, one of them owns the edge (or the corner) and the others read
// what it reads. Source: DESIGN.md, section 5.
#pragma once
#include "scene/mesh_vertices.h"

namespace tessera
{

struct MeshSeams
{
	std::vector<uint8_t> edge_flags;      // per triangle: bit e, edge e belongs to another triangle that reads it differently
	std::vector<uint32_t> corner_owners;  // per vertex: the vertex whose heights it reads; itself where nothing differs
	uint32_t seam_edges = 0;
	uint32_t seam_corners = 0;
};

// The owner of an edge is its lowest triangle in input order (and of that, its lowest edge); of a corner, the lowest one. Others differ
// when texture coordinates, densities (both ends) or the height map differ in any bit.
MeshSeams findSeams(const MeshCorners& corners, const MeshWeld& weld, const MeshVertices& vertices);

// The record of a flagged edge (3 t + e): the owner's values, in the order of this edge's ends.
SeamEdge seamEdge(uint32_t edge, const MeshWeld& weld, const MeshCorners& corners, const MeshVertices& vertices);

// The record of a vertex that another one owns.
SeamCorner seamCorner(uint32_t owner_vertex, const MeshVertices& vertices);

}  // namespace tessera
