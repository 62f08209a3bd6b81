// Seams: where triangles that meet would read different heights, one of them owns the edge (or the corner) and the others read
// what it reads. Source: DESIGN.md, section 5.
#pragma once
#include "scene/build/mesh_vertices.h"

namespace tessera
{

struct MeshSeams
{
	std::vector<uint32_t> edge_owners;    // per edge (3 t + e): the edge whose heights all edges with the same ends read
	std::vector<uint8_t> edge_flags;      // per triangle: bit e, edge e belongs to another triangle that reads it differently
	std::vector<uint32_t> corner_owners;  // per vertex: the vertex whose heights it reads; itself where nothing differs
	uint32_t seam_edges = 0;
	uint32_t seam_corners = 0;
};

// Owners are chosen by chart: triangles joined by edges that they read alike. An edge or corner belongs to the largest chart
// (of equal ones to the first in input order), within one chart to the lower texture coordinates, and an edge
// to the side that owns its ends, so that along a seam one side owns it from end to end and heights do not
// alternate between the sides. Others differ when texture coordinates, densities (both ends) or the height map differ in any bit.
MeshSeams findSeams(const MeshCorners& corners, const MeshWeld& weld, const MeshVertices& vertices);

// The record of a flagged edge (3 t + e): the owner's values, in the order of this edge's ends.
SeamEdge seamEdge(uint32_t edge, const MeshSeams& seams, const MeshWeld& weld, const MeshCorners& corners, const MeshVertices& vertices);

// The record of a vertex that another one owns.
SeamCorner seamCorner(uint32_t owner_vertex, const MeshVertices& vertices);

}  // namespace tessera
