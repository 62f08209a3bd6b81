// expand_triangles: write micro-vertices and micro-triangles out, for devices without mesh shaders.
//
//   in   full_clusters, batches
//   out  expanded_vertices    vec4[]   clip coordinates
//   out  expanded_triangles   uint[]   first three indices per triangle for the whole list, then one payload per triangle
//
// One workgroup takes one full cluster or batch at a time; ranges are taken by atomics, so their order is free.
// Host: src/pipeline/raster/expand_triangles.cpp   Test: tests/gpu/raster_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "raster/expand_triangles.h"
#include "lib/batch.glsl"
#include "lib/cluster_geometry.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Args { ExpandTrianglesArgs args; };

shared uint first_vertex;
shared uint first_triangle;

void takeRanges(uint vertices, uint triangles)
{
	if (gl_LocalInvocationIndex == 0u)
	{
		first_vertex = atomicAdd(args.counts.at[0].expanded_vertices, vertices);
		first_triangle = atomicAdd(args.counts.at[0].expanded_triangles, triangles);
	}
	barrier();
}

void writeTriangle(uint triangle, uvec3 corners, uint payload)
{
	args.indices.at[3u * triangle] = first_vertex + corners.x;
	args.indices.at[3u * triangle + 1u] = first_vertex + corners.y;
	args.indices.at[3u * triangle + 2u] = first_vertex + corners.z;
	args.indices.at[3u * args.heads.at[LIST_EXPANDED_TRIANGLES].capacity + triangle] = payload;
}

void expandCluster(uint visible)
{
	ClusterRef ref = args.inputs.visible_clusters.at[visible];
	ClusterRecord cluster = args.inputs.clusters.at[ref.cluster];
	InstanceRecord instance = args.inputs.instances.at[ref.instance];
	takeRanges(clusterVertices(cluster), clusterTriangles(cluster));
	for (uint v = gl_LocalInvocationIndex; v < clusterVertices(cluster); v += gl_WorkGroupSize.x)
		args.vertices.at[first_vertex + v] = clusterVertex(args.inputs, cluster, instance, v);
	for (uint t = gl_LocalInvocationIndex; t < clusterTriangles(cluster); t += gl_WorkGroupSize.x)
		writeTriangle(first_triangle + t, clusterTriangle(args.inputs, cluster, instance, t), packPayload(KIND_FULL_CLUSTER, visible, t));
	barrier();
}

void expandBatch(uint batch)
{
	loadBatch(args.inputs, batch);
	takeRanges(batchVertices(), batchTriangles());
	for (uint v = gl_LocalInvocationIndex; v < batchVertices(); v += gl_WorkGroupSize.x)
		args.vertices.at[first_vertex + v] = batchVertex(args.inputs, v);
	for (uint t = gl_LocalInvocationIndex; t < batchTriangles(); t += gl_WorkGroupSize.x)
	{
		MicroTriangle triangle = batchTriangle(args.inputs, t, batchFirst(batch));
		writeTriangle(first_triangle + t, triangle.vertices, triangle.payload);
	}
	barrier();
}

void main()
{
	if (args.counts.at[0].overflow != 0u)
		return;
	uint cluster_count = args.heads.at[LIST_FULL_CLUSTERS].wanted;
	for (uint index = gl_WorkGroupID.x; index < cluster_count; index += gl_NumWorkGroups.x)
		expandCluster(args.full_clusters.at[index]);
	if (!HAS_TESSELLATION || uint64_t(args.batches) == 0ul)
		return;
	uint batch_count = args.heads.at[LIST_BATCHES].wanted;
	for (uint index = gl_WorkGroupID.x; index < batch_count; index += gl_NumWorkGroups.x)
		expandBatch(args.batches.at[index]);
}
