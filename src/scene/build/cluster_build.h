// Clusters: the scene's triangles in groups that a workgroup handles, with their vertices beside them.
#pragma once
#include "scene/build.h"
#include "scene/build/seams.h"

namespace tessera
{

// One mesh between its derivation and its clusters.
struct MeshParts
{
	MeshCorners corners;
	MeshWeld weld;
	MeshNormals normals;
	MeshVertices vertices;
	MeshSeams seams;
	std::vector<uint32_t> materials;  // per primitive
	uint32_t first_weld_id = 0;       // weld ids are unique over the scene
};

// Which per-vertex arrays the scene has.
struct VertexArrays
{
	bool displacement = false;  // uvs, densities, seams
	bool directions = false;    // with displacement, and for PN triangles
	bool color_uvs = false;
	bool colors = false;
};

// Appends a mesh: its clusters, their vertices and triangles, seams and a MeshRecord. Clusters come from meshoptimizer, one primitive
// after another, in an order that depends on the input alone; every triangle appears once, degenerate ones included.
void appendClusters(const MeshParts& mesh, const BuildOptions& options, const VertexArrays& arrays, BuiltScene& scene);

}  // namespace tessera
