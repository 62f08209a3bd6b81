// Welding: which corners of a mesh's triangles are one vertex of the surface, whatever their attributes and primitives.
#pragma once
#include "scene/imported_scene.h"

namespace tessera
{

// The triangles of all primitives of a mesh, one after another: input order. Corner 3 t + c, edge 3 t + e (from corner e to e + 1).
struct MeshCorners
{
	std::vector<vec3> positions;            // per corner
	std::vector<uint32_t> first_triangles;  // per primitive, and the count of all at the end

	uint32_t triangleCount() const { return first_triangles.back(); }
};

// Corners are one welded vertex when a chain of triangles, each sharing an edge with the next at that corner, joins them (a fan).
// Sharing an edge means equal positions (bits) at both ends, in any orientation and by any number of triangles.
struct MeshWeld
{
	std::vector<uint32_t> corner_welds;   // per corner: its welded vertex, numbered from 0 in order of the first corner
	std::vector<uint32_t> first_corners;  // per welded vertex: its lowest corner
	std::vector<uint32_t> edge_owners;    // per edge: the lowest edge with the same ends (itself when it is that one)
	uint32_t boundary_edges = 0;          // welded edges of one triangle
	uint32_t nonmanifold_edges = 0;       // welded edges of more than two
};

// The next corner of the same triangle: the other end of edge `corner`.
inline uint32_t nextCorner(uint32_t corner)
{
	return corner % 3 == 2 ? corner - 2 : corner + 1;
}

// Lays a mesh's triangles out by corner. The mesh has fewer than 2^32 / 3 triangles.
MeshCorners layOutCorners(const Mesh& mesh);

// Welds. Time and memory are linear in the triangles: about 40 bytes each at the peak.
MeshWeld weldMesh(const MeshCorners& corners);

}  // namespace tessera
