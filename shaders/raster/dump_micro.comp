// dump_micro: write out the very micro-vertices and micro-triangles that a rasteriser draws, for export and verification.
//
//   in   full_clusters, batches
//   out  micro_dump   DumpHead, DumpItem[], DumpVertex[], DumpTriangle[]   item i is full cluster i, after those batch i; what
//                     exceeds a capacity is left out, and the host makes it larger and draws again
//
// Every raster path evaluates its vertices by the same functions from the same lists, so this stands for each of them.
// Host: src/pipeline/raster/dump_micro.cpp   Test: tests/gpu/export_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
// Before every include: glslang takes a workgroup size that is used before it is declared for 1.
layout(local_size_x_id = 0) in;
// Batches of any producer of visibility.
#define STAGED_PARTS BATCH_MAX_PARTS
#define STAGED_VERTICES RASTER_BATCH_VERTICES
#define STAGED_TRIANGLES RASTER_BATCH_TRIANGLES
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raster/dump_micro.h"
#include "lib/shading_normal.glsl"
#include "lib/work_item.glsl"

layout(push_constant, scalar) uniform Args { DumpMicroArgs args; };

// A micro-vertex before its height is read: whose it is, and where in which base triangle.
struct DumpSource
{
	uint owner;
	DomainPoint name;   // what the dump calls it
	DomainPoint point;  // in `base`
	BaseTriangle base;
	Placement placement;
	SurfaceSample at;
};

// A triangle of the cluster that has the vertex, and which of its corners that is.
uvec2 triangleWithVertex(ClusterRecord cluster, uint vertex)
{
	for (uint t = 0u; t < clusterTriangles(cluster); ++t)
		for (uint corner = 0u; corner < 3u; ++corner)
			if (triangleVertex(frame_surface.triangles.at[cluster.first_triangle + t], corner) == vertex)
				return uvec2(t, corner);
	return uvec2(0u);
}

DumpSource clusterSource(WorkItem item, uint index)
{
	DumpSource source;
	source.owner = item.parts;
	source.name = DomainPoint(index, 0u);
	uvec2 use = HAS_SMOOTH_NORMALS ? triangleWithVertex(item_cluster, index) : uvec2(0u);
	source.base = baseTriangle(frame_surface, item_cluster, use.x);
	source.point = domainCorner(use.y);
	source.placement = partPlacement(0u);
	source.at = clusterSample(args.inputs, item_cluster, index);
	return source;
}

DumpSource batchSource(WorkItem item, uint index)
{
	uint part = vertexOwner(index);
	DumpSource source;
	source.owner = part_indices[part];
	source.base = part_bases[part];
	source.point = batchPoint(args.inputs, index, part);
	source.name = source.point;
	source.placement = partPlacement(part);
	source.at = batchSample(args.inputs, index, part);
	return source;
}

vec3 normalOf(DumpSource source)
{
	if (!HAS_SMOOTH_NORMALS)
		return vec3(0.0);
	ShadingData shading = args.shading.at[0];
	vec3 weights = domainWeights(source.point);
	vec3 normals[3] = vec3[3](shading.normals.at[source.base.v0], shading.normals.at[source.base.v1], shading.normals.at[source.base.v2]);
	return displacedNormal(frame_surface, source.base, weights, normals, source.placement, frame_view).normal;
}

DumpVertex dumpVertex(WorkItem item, uint index)
{
	DumpSource source;
	if (HAS_TESSELLATION && item.is_batch)
		source = batchSource(item, index);
	else
		source = clusterSource(item, index);
	vec3 point = displaced(frame_surface, source.at, source.placement, frame_view).displaced;
	return DumpVertex(point, normalOf(source), source.owner, source.name.u, source.name.v);
}

shared uint first_vertex;
shared uint first_triangle;

// Ranges for an item; by one lane. An item that does not fit stays empty.
void takeRanges(DumpHead dump, WorkItem item, uint index)
{
	first_vertex = atomicAdd(args.counts.at[0].dump_vertices, item.vertex_count);
	first_triangle = atomicAdd(args.counts.at[0].dump_triangles, item.triangle_count);
	bool fits = first_vertex + item.vertex_count <= dump.vertex_capacity && first_triangle + item.triangle_count <= dump.triangle_capacity;
	dump.items.at[index] = DumpItem(first_vertex, fits ? item.vertex_count : 0u, first_triangle, fits ? item.triangle_count : 0u);
}

void dumpItem(DumpHead dump, WorkItem item, uint index)
{
	if (gl_LocalInvocationIndex == 0u)
		takeRanges(dump, item, index);
	barrier();
	for (uint v = gl_LocalInvocationIndex; v < item.vertex_count; v += gl_WorkGroupSize.x)
		if (first_vertex + v < dump.vertex_capacity)
			dump.vertices.at[first_vertex + v] = dumpVertex(item, v);
	for (uint t = gl_LocalInvocationIndex; t < item.triangle_count; t += gl_WorkGroupSize.x)
	{
		MicroTriangle triangle = itemTriangle(args.inputs, item, t);
		uint corners = triangle.vertices.x | (triangle.vertices.y << 10) | (triangle.vertices.z << 20);
		if (first_triangle + t < dump.triangle_capacity)
			dump.triangles.at[first_triangle + t] = DumpTriangle(corners, triangle.payload);
	}
	barrier();
}

void main()
{
	if (args.counts.at[0].overflow != 0u)
		return;
	uint cluster_count = args.heads.at[LIST_FULL_CLUSTERS].wanted;
	uint item_count = cluster_count + (HAS_TESSELLATION ? args.heads.at[LIST_BATCHES].wanted : 0u);
	DumpHead dump = args.dump.at[0];
	item_count = min(item_count, dump.item_capacity);
	for (uint index = gl_WorkGroupID.x; index < item_count; index += gl_NumWorkGroups.x)
	{
		if (HAS_OCCLUSION && index < cluster_count && args.full_clusters.at[index].phase == PHASE_HIDDEN)
		{
			dump.items.at[index] = DumpItem(0u, 0u, 0u, 0u);
			continue;
		}
		dumpItem(dump, workItem(args.inputs, args.full_clusters, args.batches, index, cluster_count), index);
	}
}
