// raster_micro: evaluate the micro-vertices of a full cluster or batch into shared memory and rasterise them there. Where raster_small
// has been before, only the items that it left; as raster_revealed, those of the second phase.
//
//   in   full_clusters, batches
//   in   left_items           uint[]     with SMALL_FIRST: numbers of items, from raster_small
//   out  visibility_buffer   uint64[]   per pixel, depth << 32 | payload, by atomicMax
//
// One workgroup takes one full cluster or batch at a time: lanes stride over its vertices, then over its triangles.
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
#include "lib/soft_raster_large.glsl"

void rasterTriangles(WorkItem item, bool projected, View view)
{
	VisibilityRef target = VisibilityRef(args.visibility);
	for (uint t = gl_LocalInvocationIndex; t < item.triangle_count; t += gl_WorkGroupSize.x)
	{
		MicroTriangle triangle = itemTriangle(args.inputs, item, t);
		rasterTriangle(target, t, triangle.vertices, triangle.payload, isTwoSided(item, t), projected, view);
	}
}

// The whole workgroup takes what single lanes left.
void rasterWideTriangles(WorkItem item, bool projected, View view)
{
	VisibilityRef target = VisibilityRef(args.visibility);
	for (uint word = 0u; word < MAX_RASTER_TRIANGLES / 32u; ++word)
		for (uint left = raster_wide[word]; left != 0u; left &= left - 1u)
		{
			uint t = 32u * word + uint(findLSB(left));
			MicroTriangle triangle = itemTriangle(args.inputs, item, t);
			rasterLeft(target, triangle.vertices, triangle.payload, isTwoSided(item, t), projected, view);
		}
}

// Ends with a barrier. Where a vertex lies outside the guard band, all are stored again; says whether they are stored projected.
bool storeVertices(WorkItem item, View view)
{
	for (bool projects = true;; projects = false)
	{
		for (uint v = gl_LocalInvocationIndex; v < item.vertex_count; v += gl_WorkGroupSize.x)
			storeRasterVertex(v, itemVertex(args.inputs, item, v), projects, view);
		barrier();
		if (!projects || raster_has_outside == 0u)
			return projects;
		// All lanes have read that some are outside before any is stored again.
		barrier();
	}
}

void rasterItem(WorkItem item, View view)
{
	bool projected = storeVertices(item, view);
	rasterTriangles(item, projected, view);
	barrier();
	if (raster_any_wide != 0u)
		rasterWideTriangles(item, projected, view);
	barrier();
}

void rasterNumbered(uint number, uint cluster_count, View view)
{
	beginRaster();
	rasterItem(workItem(args.inputs, args.full_clusters, args.batches, number, cluster_count), view);
}

void main()
{
	if (args.counts.at[0].overflow != 0u)
		return;
	View view = frame_view;
	PhaseItems items = phaseItems();
	bool is_rest = SMALL_FIRST && args.phase == PHASE_FIRST;
	uint count = is_rest ? args.counts.at[0].left_items : items.count;
	for (uint index = gl_WorkGroupID.x; index < count; index += gl_NumWorkGroups.x)
	{
		uint number = is_rest ? args.left_items.at[index] : itemNumber(items, index);
		if (is_rest || isOfPhase(items, index))
			rasterNumbered(number, items.clusters, view);
	}
}
