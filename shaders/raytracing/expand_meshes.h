// Arguments of expand_meshes.
#ifndef TESSERA_RAYTRACING_EXPAND_MESHES_H
#define TESSERA_RAYTRACING_EXPAND_MESHES_H
#include "shared/geometry.h"

SHARED_BEGIN

struct ExpandMeshesArgs
{
	GPU_PTR(ClusterRecord) clusters;
	GPU_PTR(vec3) vertices;  // of all meshes that are made in this frame, one after another
	GPU_PTR(uint) indices;   // three per triangle, counted from the mesh's first vertex
	uint first_cluster;
	uint cluster_count;
	uint vertex_place;    // where the scene's vertex 0 would lie, modulo 2^32
	uint triangle_place;  // and its triangle 0
};
SHARED_LAYOUT(ExpandMeshesArgs, 40, triangle_place, 36)

SHARED_END

#endif
