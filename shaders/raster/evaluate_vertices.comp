// evaluate_vertices: displace the micro-vertices of full clusters and batches, for the passes that draw them.
//
//   in   full_clusters, batches
//   out  micro_vertices       vec4[]   clip coordinates; a batch's or cluster's range was taken when it was listed
//   out  expanded_triangles   uint[]   only when drawn indexed: three indices per triangle for the whole list, then one
//                                      payload per triangle; ranges are taken by atomics, so their order is free
//
// In compute and not in the mesh shader: some devices run mesh shaders on few of their processors, and the same vertices
// serve the indexed draw. One workgroup takes one full cluster or batch at a time.
// Host: src/pipeline/raster/evaluate_vertices.cpp   Test: tests/gpu/raster_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "raster/evaluate_vertices.h"
#include "lib/batch_vertices.glsl"
#include "lib/cluster_geometry.glsl"

layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Args { EvaluateVerticesArgs args; };

shared uint first_triangle;

void takeTriangles(uint count)
{
	if (gl_LocalInvocationIndex == 0u)
		first_triangle = atomicAdd(args.counts.at[0].expanded_triangles, count);
	barrier();
}

void writeTriangle(uint triangle, uint first_vertex, uvec3 corners, uint payload)
{
	args.indices.at[3u * triangle] = first_vertex + corners.x;
	args.indices.at[3u * triangle + 1u] = first_vertex + corners.y;
	args.indices.at[3u * triangle + 2u] = first_vertex + corners.z;
	args.indices.at[3u * args.heads.at[LIST_EXPANDED_TRIANGLES].capacity + triangle] = payload;
}

void evaluateCluster(FullCluster full)
{
	ClusterRef ref = args.inputs.visible_clusters.at[full.visible_cluster];
	ClusterRecord cluster = args.inputs.clusters.at[ref.cluster];
	InstanceRecord instance = args.inputs.instances.at[ref.instance];
	for (uint v = gl_LocalInvocationIndex; v < clusterVertices(cluster); v += gl_WorkGroupSize.x)
		args.vertices.at[full.first_vertex + v] = clusterVertex(args.inputs, cluster, instance, v);
	if (!EXPANDS_TRIANGLES)
		return;
	takeTriangles(clusterTriangles(cluster));
	for (uint t = gl_LocalInvocationIndex; t < clusterTriangles(cluster); t += gl_WorkGroupSize.x)
	{
		uvec3 corners = clusterTriangle(args.inputs, cluster, instance, t);
		writeTriangle(first_triangle + t, full.first_vertex, corners, packPayload(KIND_FULL_CLUSTER, full.visible_cluster, t));
	}
	barrier();
}

void evaluateBatch(Batch batch)
{
	loadBatch(args.inputs, batch.parts);
	loadBatchParts(args.inputs, batch.parts);
	for (uint v = gl_LocalInvocationIndex; v < batchVertices(); v += gl_WorkGroupSize.x)
		args.vertices.at[batch.first_vertex + v] = batchVertex(args.inputs, v);
	if (EXPANDS_TRIANGLES)
	{
		takeTriangles(batchTriangles());
		for (uint t = gl_LocalInvocationIndex; t < batchTriangles(); t += gl_WorkGroupSize.x)
		{
			MicroTriangle triangle = batchTriangle(args.inputs, t, batch.parts);
			writeTriangle(first_triangle + t, batch.first_vertex, triangle.vertices, triangle.payload);
		}
	}
	barrier();
}

void main()
{
	if (args.counts.at[0].overflow != 0u)
		return;
	uint cluster_count = args.heads.at[LIST_FULL_CLUSTERS].wanted;
	for (uint index = gl_WorkGroupID.x; index < cluster_count; index += gl_NumWorkGroups.x)
		evaluateCluster(args.full_clusters.at[index]);
	if (!HAS_TESSELLATION || uint64_t(args.batches) == 0ul)
		return;
	uint batch_count = args.heads.at[LIST_BATCHES].wanted;
	for (uint index = gl_WorkGroupID.x; index < batch_count; index += gl_NumWorkGroups.x)
		evaluateBatch(args.batches.at[index]);
}
