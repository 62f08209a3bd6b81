// geometry.h: the scene's geometry as the GPU holds it, all meshes one after another. Written by scene/, read by every stage.
#ifndef TESSERA_SHARED_GEOMETRY_H
#define TESSERA_SHARED_GEOMETRY_H
#include "shared/domain.h"
#include "shared/hidden.h"

SHARED_BEGIN

#define NO_INDEX 0xffffffffu

// Up to 128 triangles and 128 vertices of one primitive.
struct ClusterRecord
{
	uint first_vertex;
	uint first_triangle;
	uint counts;  // vertices | triangles << 8
	uint material;
};
SHARED_LAYOUT(ClusterRecord, 16, material, 12)

struct MeshRecord
{
	uint first_cluster;
	uint cluster_count;
};
SHARED_LAYOUT(MeshRecord, 8, cluster_count, 4)

// A cluster of one instance: the record of visible_clusters.
struct ClusterRef
{
	uint instance;
	uint cluster;  // global index
};
SHARED_LAYOUT(ClusterRef, 8, cluster, 4)

SHARED_FN uint clusterVertices(ClusterRecord cluster)
{
	return cluster.counts & 0xffu;
}
SHARED_FN uint clusterTriangles(ClusterRecord cluster)
{
	return (cluster.counts >> 8) & 0xffu;
}

// A triangle is one word: three 7-bit vertex indices within the cluster, three edge flags, three seam flags.
//   bits 0-20  corners 0, 1, 2
//   bits 21-23 edge e (corner e to e + 1) starts at its end with the lower weld id
//   bits 24-26 edge e lies on a seam that another triangle owns: its heights come from a SeamEdge
SHARED_FN uint triangleVertex(uint triangle, uint corner)
{
	return (triangle >> (7u * corner)) & 0x7fu;
}
SHARED_FN uint triangleEdgeFlags(uint triangle)
{
	return (triangle >> 21) & 7u;
}
SHARED_FN uint triangleSeamFlags(uint triangle)
{
	return (triangle >> 24) & 7u;
}
SHARED_FN uint packBaseTriangle(uint v0, uint v1, uint v2, uint edge_flags, uint seam_flags)
{
	return v0 | (v1 << 7) | (v2 << 14) | (edge_flags << 21) | (seam_flags << 24);
}

// A height map with its mips, box-filtered at load; texels of all levels one after another. Where memory allows it, devices keep for every texel
// its footprint instead, the four texels that a bilinear read takes, wrapped: one read of 4, 8 or 16 bytes (src/frame/height_footprints.h).
#define UNIFORM_HEIGHT_MAPS 64  // up to this many are read from a uniform buffer
#define MAX_HEIGHT_LEVELS 16
#define FOOTPRINT_BORDER 3u  // footprints in a row beside one per texel: from texel -2 on, to that of the texel after the last
#define HEIGHT_U8 0u
#define HEIGHT_U16 1u
#define HEIGHT_F32 2u
#define WRAP_REPEAT 0u
#define WRAP_CLAMP 1u
#define WRAP_MIRROR 2u
struct HeightMap
{
	GPU_PTR(uint) texels;  // packed little endian: 4 x U8, 2 x U16 or 1 x F32 per word; or footprints, row after row
	uint width;            // of level 0
	uint height;
	uint level_count;  // 1..15
	uint format;       // HEIGHT_*
	uint wrap_u;       // WRAP_*
	uint wrap_v;
	float factor;  // displacement = (height * factor + offset) * scale, mesh units
	float offset;
	uint level_first[MAX_HEIGHT_LEVELS];  // first texel, or footprint, of each level
};
SHARED_LAYOUT(HeightMap, 104, level_first, 40)

// Heights along an edge that another triangle owns: the owner's texture coordinates at the edge's ends (corner e, e + 1).
struct SeamEdge
{
	vec2 uv_first;
	vec2 uv_second;
	float density_first;
	float density_second;
	uint height_map;  // NO_INDEX: the owner does not displace
};
SHARED_LAYOUT(SeamEdge, 28, height_map, 24)

// Height at a vertex that another triangle owns.
struct SeamCorner
{
	vec2 uv;
	float density;
	uint height_map;
};
SHARED_LAYOUT(SeamCorner, 16, height_map, 12)

// Of the metric `detail`, per triangle: how far its displaced surface lies from flat pieces of it (shared/edge_detail.h).
struct TriangleDetail
{
	uint curves[8];  // two words each: the largest of all triangles that meet at edge 0, 1, 2; the triangle's own
	int bias;        // what a curve's numbers begin at; the same for the whole scene
};
SHARED_LAYOUT(TriangleDetail, 36, bias, 32)

// What the displaced surface is evaluated from. Absent arrays (address 0) are not needed by the scene.
struct Surface
{
	GPU_PTR(vec3) positions;         // per vertex, mesh units
	GPU_PTR(vec3) directions;        // per vertex: direction of its welded fan, for displacement and PN triangles; unit or zero
	GPU_PTR(vec2) uvs;               // per vertex: height map coordinates, transforms applied
	GPU_PTR(float) densities;        // per vertex: height texels per mesh unit
	GPU_PTR(uint) triangles;         // per triangle, see above
	GPU_PTR(uint) first_seam_edges;  // per triangle: its first SeamEdge; only with seams
	GPU_PTR(SeamEdge) seam_edges;
	GPU_PTR(uint) seam_corner_indices;  // per vertex: its SeamCorner or NO_INDEX; only with seams
	GPU_PTR(SeamCorner) seam_corners;
	GPU_PTR(uint) material_height_maps;  // per material: its HeightMap or NO_INDEX
	GPU_PTR(HeightMap) height_maps;
	GPU_PTR(TriangleDetail) triangle_details;  // per triangle; metric `detail`
	GPU_PTR(vec3) edge_roughness;              // per triangle, its three edges; metric `displaced`
	GPU_PTR(vec3) pn_directions;               // `directions` once more where base triangles are PN triangles (shared/pn.h)
	GPU_PTR(HiddenInstance) hidden_instances;  // per instance; where segments grow on what is hidden
};
SHARED_LAYOUT(Surface, 120, hidden_instances, 112)

SHARED_END

#endif
