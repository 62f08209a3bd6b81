// raster_small: as raster_micro, for items within the guard band; leaves the others, and those with a triangle that is too large for one
// lane, to raster_micro, whose code for them would cost every workgroup time.
//
//   in   full_clusters, batches
//   out  visibility_buffer   uint64[]   per pixel, depth << 32 | payload, by atomicMax
//   out  left_items          uint[]     items that are not done; their small triangles may be, which does no harm
//
// Host: src/pipeline/raster/raster_micro.cpp   Test: tests/gpu/raster_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_atomic_int64 : require
// Before every include: glslang takes a workgroup size that is used before it is declared for 1.
layout(local_size_x_id = 0) in;
#define STAGED_PARTS RASTER_BATCH_PARTS
#define STAGED_VERTICES RASTER_BATCH_VERTICES
#define STAGED_TRIANGLES RASTER_BATCH_TRIANGLES
#include "lib/raster_items.glsl"
#include "lib/soft_raster.glsl"

shared uint has_large;  // 1: a triangle is too large for one lane

// Ends with a barrier.
void storeVertices(WorkItem item, View view)
{
	for (uint v = gl_LocalInvocationIndex; v < item.vertex_count; v += gl_WorkGroupSize.x)
		storeScreenVertex(v, clipPosition(itemVertex(args.inputs, item, v), view), view);
	barrier();
}

void rasterTriangles(WorkItem item, View view)
{
	VisibilityRef target = VisibilityRef(args.visibility);
	for (uint t = gl_LocalInvocationIndex; t < item.triangle_count; t += gl_WorkGroupSize.x)
	{
		MicroTriangle triangle = itemTriangle(args.inputs, item, t);
		uvec3 corners = triangle.vertices;
		if (!rasterUnlessLarge(target, keptScreenVertex(corners.x), keptScreenVertex(corners.y), keptScreenVertex(corners.z), ALL_ROWS,
		                       triangle.payload, isTwoSided(item, t), view))
			has_large = 1u;
	}
}

// Ends with a barrier.
void rasterNumbered(uint number, uint cluster_count, View view)
{
	bool is_first_lane = gl_LocalInvocationIndex == 0u;
	if (is_first_lane)
	{
		raster_has_outside = 0u;
		has_large = 0u;
	}
	WorkItem item = workItem(args.inputs, args.full_clusters, args.batches, number, cluster_count);
	storeVertices(item, view);
	if (raster_has_outside == 0u)
		rasterTriangles(item, view);
	barrier();
	if (is_first_lane && (raster_has_outside | has_large) != 0u)
		args.left_items.at[atomicAdd(args.counts.at[0].left_items, 1u)] = number;
}

void main()
{
	if (args.counts.at[0].overflow != 0u)
		return;
	View view = frame_view;
	PhaseItems items = phaseItems();
	for (uint index = gl_WorkGroupID.x; index < items.count; index += gl_NumWorkGroups.x)
		if (isOfPhase(items, index))
			rasterNumbered(itemNumber(items, index), items.clusters, view);
}
