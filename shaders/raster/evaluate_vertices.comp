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
// Before every include: glslang takes a workgroup size that is used before it is declared for 1.
layout(local_size_x_id = 0) in;
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raster/evaluate_vertices.h"
#include "lib/work_item.glsl"

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

void evaluateItem(WorkItem item)
{
	for (uint v = gl_LocalInvocationIndex; v < item.vertex_count; v += gl_WorkGroupSize.x)
		args.vertices.at[item.first_vertex + v] = clipPosition(itemVertex(args.inputs, item, v), frame_view);
	if (EXPANDS_TRIANGLES)
	{
		takeTriangles(item.triangle_count);
		for (uint t = gl_LocalInvocationIndex; t < item.triangle_count; t += gl_WorkGroupSize.x)
		{
			MicroTriangle triangle = itemTriangle(args.inputs, item, t);
			writeTriangle(first_triangle + t, item.first_vertex, triangle.vertices, triangle.payload);
		}
	}
	barrier();
}

void main()
{
	if (args.counts.at[0].overflow != 0u)
		return;
	uint cluster_count = args.heads.at[LIST_FULL_CLUSTERS].wanted;
	uint item_count = cluster_count + (HAS_TESSELLATION ? args.heads.at[LIST_BATCHES].wanted : 0u);
	for (uint index = gl_WorkGroupID.x; index < item_count; index += gl_NumWorkGroups.x)
		evaluateItem(workItem(args.inputs, args.full_clusters, args.batches, index, cluster_count));
}
