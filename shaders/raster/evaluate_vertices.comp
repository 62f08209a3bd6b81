// evaluate_vertices: displace the micro-vertices of full clusters and batches, for the passes that draw them.
//
//   in   full_clusters, batches
//   out  micro_vertices       vec4[]   clip coordinates, or places relative to the eye where rays are traced; a batch's or cluster's range was
//                                      taken when it was listed. Behind the last one that the list can hold lies one more, for triangles that are not there in a frame without any
//   out  expanded_triangles   uint[]   only when drawn indexed or traced: three indices per triangle for the whole list, then one
//                                      payload per triangle; ranges are taken by atomics, so their order is free, unless
//                                      every cluster keeps its place (KEEPS_PLACES). A build takes its count
//                                      from the host: triangles that it has and the frame has not get no area.
//                                      Full clusters of instances that share structures (PHASE_SHARED) get no triangles, and vertices only
//                                      where they are drawn
//
// In compute and not in the mesh shader: some devices run mesh shaders on few of their processors, and the same vertices
// serve the indexed draw. One workgroup takes one full cluster or batch at a time.
// Host: src/pipeline/raster/evaluate_vertices.cpp   Test: tests/gpu/raster_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
// Before every include: glslang takes a workgroup size that is used before it is declared for 1.
layout(local_size_x_id = 0) in;
// Batches of mesh shaders or, where rays are traced beside or in place of the compute rasteriser, of that.
#define STAGED_PARTS BATCH_MAX_PARTS
#define STAGED_VERTICES RASTER_BATCH_VERTICES
#define STAGED_TRIANGLES RASTER_BATCH_TRIANGLES
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raster/evaluate_vertices.h"
#include "lib/micro_vertices.glsl"
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

// The item's vertices begin there.
uint vertexPlace(WorkItem item)
{
	return KEEPS_PLACES ? args.inputs.instances.at[args.inputs.visible_clusters.at[item.parts].instance].vertex_place + item_cluster.first_vertex
	                    : item.first_vertex;
}

// And its triangles, in first_triangle. Ends with a barrier.
void placeTriangles(WorkItem item)
{
	if (!KEEPS_PLACES)
	{
		takeTriangles(item.triangle_count);
		return;
	}
	if (gl_LocalInvocationIndex == 0u)
		first_triangle = args.inputs.instances.at[args.inputs.visible_clusters.at[item.parts].instance].triangle_place + item_cluster.first_triangle;
	barrier();
}

void evaluateItem(WorkItem item, bool expands)
{
	uint first_vertex = vertexPlace(item);
	for (uint v = gl_LocalInvocationIndex; v < item.vertex_count; v += gl_WorkGroupSize.x)
		args.vertices.at[first_vertex + v] = keptVertex(itemVertex(args.inputs, item, v));
	if (EXPANDS_TRIANGLES && expands)
	{
		placeTriangles(item);
		for (uint t = gl_LocalInvocationIndex; t < item.triangle_count; t += gl_WorkGroupSize.x)
		{
			MicroTriangle triangle = itemTriangle(args.inputs, item, t);
			writeTriangle(first_triangle + t, first_vertex, triangle.vertices, triangle.payload);
		}
	}
	barrier();
}

// Triangles [first, args.traced_triangles) get the same vertex three times: no ray meets them. It is the frame's first vertex, so that only rays to
// that very place meet their boxes (at the eye every ray would), or, where there is none, one behind the eye.
void deactivateTriangles(uint first, bool has_vertices)
{
	uint nowhere = has_vertices ? 0u : args.heads.at[LIST_MICRO_VERTICES].capacity;
	if (!has_vertices && gl_GlobalInvocationID.x == 0u)
		args.vertices.at[nowhere] = vec4(frame_view.draw_eye - frame_view.forward, 1.0);
	uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
	for (uint i = 3u * first + gl_GlobalInvocationID.x; i < 3u * args.traced_triangles; i += stride)
		args.indices.at[i] = nowhere;
}

void main()
{
	bool overflow = args.counts.at[0].overflow != 0u;
	uint cluster_count = args.heads.at[LIST_FULL_CLUSTERS].wanted;
	uint item_count = cluster_count + (HAS_TESSELLATION ? args.heads.at[LIST_BATCHES].wanted : 0u);
	if (HAS_RAYS && EXPANDS_TRIANGLES)
		deactivateTriangles(overflow ? 0u : args.heads.at[LIST_EXPANDED_TRIANGLES].wanted, !overflow && args.heads.at[LIST_MICRO_VERTICES].wanted > 0u);
	if (overflow)
		return;
	for (uint index = gl_WorkGroupID.x; index < item_count; index += gl_NumWorkGroups.x)
	{
		bool is_shared = SHARES_STRUCTURES && index < cluster_count && args.full_clusters.at[index].phase == PHASE_SHARED;
		if (!(is_shared && READS_BUFFER))
			evaluateItem(workItem(args.inputs, args.full_clusters, args.batches, index, cluster_count), !is_shared);
	}
}
