// raster_micro: evaluate the micro-vertices of a full cluster or batch into shared memory and rasterise them there.
//
//   in   full_clusters, batches
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
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raster/raster_micro.h"
#include "lib/soft_raster.glsl"
#include "lib/work_item.glsl"

layout(push_constant, scalar) uniform Args { RasterMicroArgs args; };

bool isTwoSided(WorkItem item, uint triangle)
{
	if (!HAS_MIXED_SIDES)
		return !HAS_SINGLE_SIDED;
	return (args.inputs.material_flags.at[itemMaterial(item, triangle)] & MATERIAL_DOUBLE_SIDED) != 0u;
}

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

// Items of this phase: full clusters by their own word, batches by range.
void main()
{
	if (args.counts.at[0].overflow != 0u)
		return;
	View view = frame_view;
	bool second = HAS_OCCLUSION && args.phase == PHASE_SECOND;
	uint cluster_count = args.heads.at[LIST_FULL_CLUSTERS].wanted;
	uint first_batch = second ? args.counts.at[0].second_batches : 0u;
	uint batch_end = HAS_TESSELLATION ? (HAS_OCCLUSION && !second ? args.counts.at[0].second_batches : args.heads.at[LIST_BATCHES].wanted) : 0u;
	uint item_count = cluster_count + batch_end - first_batch;
	for (uint index = gl_WorkGroupID.x; index < item_count; index += gl_NumWorkGroups.x)
	{
		if (HAS_OCCLUSION && index < cluster_count && args.full_clusters.at[index].phase != args.phase)
			continue;
		beginRaster();
		uint item = index < cluster_count ? index : index + first_batch;
		rasterItem(workItem(args.inputs, args.full_clusters, args.batches, item, cluster_count), view);
	}
}
