// A full cluster: drawn as stored, its vertices displaced.
#ifndef TESSERA_LIB_CLUSTER_GEOMETRY
#define TESSERA_LIB_CLUSTER_GEOMETRY
#include "lib/frame_data.glsl"
#include "shared/raster_inputs.h"

SurfaceSample clusterSample(RasterInputs inputs, ClusterRecord cluster, uint vertex)
{
	Surface surface = frame_surface;
	uint height_map = HAS_DISPLACEMENT ? surface.material_height_maps.at[cluster.material] : NO_INDEX;
	return sampleAtVertex(surface, cluster.first_vertex + vertex, height_map);
}

// `mirrored`: of the instance; 1: triangles turn over.
uvec3 clusterTriangle(ClusterRecord cluster, uint mirrored, uint triangle)
{
	uint base = frame_surface.triangles.at[cluster.first_triangle + triangle];
	uvec3 corners = uvec3(triangleVertex(base, 0u), triangleVertex(base, 1u), triangleVertex(base, 2u));
	return HAS_MIRRORED_INSTANCES && mirrored != 0u ? corners.yxz : corners;
}

#endif
