// expand_meshes: vertices and indices of a mesh in its own space, for the structure that its instances share when rays are traced.
//
//   in   clusters, surface
//   out  mesh_inputs   vec3[]   displaced as an untessellated full cluster is, mesh units: what is displaced comes here only where nothing is
//                               tessellated, and then heights are of the finest mip from everywhere
//                      uint[]   three indices per triangle, in the order of the scene's triangles
//
// One dispatch per mesh; one workgroup takes one cluster at a time.
// Host: src/pipeline/raytracing/build_meshes.cpp   Test: tests/gpu/raytracing/sharing_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x_id = 0) in;
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raytracing/expand_meshes.h"
#include "lib/cluster_geometry.glsl"

layout(push_constant, scalar) uniform Args { ExpandMeshesArgs args; };

void expandVertices(ClusterRecord cluster)
{
	RasterInputs none;
	Placement nowhere;
	nowhere.row0 = nowhere.row1 = nowhere.row2 = nowhere.translation = vec3(0.0);
	nowhere.inverse_scale_squared = 0.0;
	nowhere.triangle_reach = 0.0;
	for (uint v = gl_LocalInvocationIndex; v < clusterVertices(cluster); v += gl_WorkGroupSize.x)
	{
		SurfaceSample at = clusterSample(none, cluster, v);
		args.vertices.at[args.vertex_place + cluster.first_vertex + v] = displaced(frame_surface, at, nowhere, frame_view).displaced;
	}
}

void expandTriangles(ClusterRecord cluster)
{
	uint first_vertex = cluster.first_vertex - args.clusters.at[args.first_cluster].first_vertex;
	for (uint t = gl_LocalInvocationIndex; t < clusterTriangles(cluster); t += gl_WorkGroupSize.x)
	{
		uvec3 corners = clusterTriangle(cluster, 0u, t) + first_vertex;
		uint first = 3u * (args.triangle_place + cluster.first_triangle + t);
		args.indices.at[first] = corners.x;
		args.indices.at[first + 1u] = corners.y;
		args.indices.at[first + 2u] = corners.z;
	}
}

void main()
{
	for (uint i = gl_WorkGroupID.x; i < args.cluster_count; i += gl_NumWorkGroups.x)
	{
		ClusterRecord cluster = args.clusters.at[args.first_cluster + i];
		expandVertices(cluster);
		expandTriangles(cluster);
	}
}
