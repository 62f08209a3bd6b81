// raster_micro: evaluate the micro-vertices of a full cluster or batch into shared memory and rasterise them there. Where raster_small
// has been before, only the items that it left; as raster_revealed, those of the second phase.
//
//   in   full_clusters, batches
//   in   left_items           uint[]     with SMALL_FIRST: numbers of items, from raster_small
//   out  visibility_buffer   uint64[]   per pixel, depth << 32 | payload, by atomicMax
//
// One workgroup takes one full cluster or batch at a time, or a share of its triangles: lanes stride over its vertices, then over its triangles
// or, where those are larger, over their rows.
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

// Part of an item's triangles: a GPU is not filled by few items, so that several workgroups then share each.
struct Share
{
	uint index;
	uint count;
};

// A processor's workgroups are small, and few of them fill it.
const bool SHARES_WORK = gl_WorkGroupSize.x >= 64u;
const uint MOST_SHARES = 8u;
const uint FILLING_WORKGROUPS = 512u;  // with more, a GPU has no room for them at once, and each evaluates all vertices of its item
const uint SAMPLED_TRIANGLES = 64u;
const uint ROW_LANE_PX = 8u;  // of a bounding box, for each lane

shared uint sampled_box_px;  // of all sampled triangles

// Pixels of the bounding box of one of the item's triangles.
uint boxPx(WorkItem item, uint t, View view)
{
	uvec3 corners = itemTriangle(args.inputs, item, t).vertices;
	PixelBox box = pixelBox(keptScreenVertex(corners.x).position, keptScreenVertex(corners.y).position, keptScreenVertex(corners.z).position, view);
	ivec2 size = clamp(boxSize(box), ivec2(0), ivec2(64));
	return uint(size.x * size.y);
}

// How many lanes share a triangle's rows: more the larger the item's triangles are, by a sample of them. A power of two. Ends with a barrier.
uint lanesPerTriangle(WorkItem item, View view)
{
	uint samples = min(item.triangle_count, SAMPLED_TRIANGLES);
	if (gl_LocalInvocationIndex < samples)
		atomicAdd(sampled_box_px, boxPx(item, gl_LocalInvocationIndex * item.triangle_count / samples, view));
	barrier();
	uint wanted = sampled_box_px / (samples * ROW_LANE_PX);
	return wanted == 0u ? 1u : min(1u << findMSB(wanted), 16u);
}

void rasterTriangles(WorkItem item, Share share, bool projected, View view)
{
	VisibilityRef target = VisibilityRef(args.visibility);
	uint lanes = SHARES_WORK && projected && item.triangle_count > 0u ? lanesPerTriangle(item, view) : 1u;
	for (uint i = share.index * gl_WorkGroupSize.x + gl_LocalInvocationIndex; i < item.triangle_count * lanes; i += share.count * gl_WorkGroupSize.x)
	{
		uint t = i / lanes;
		MicroTriangle triangle = itemTriangle(args.inputs, item, t);
		rasterTriangle(target, t, triangle.vertices, Rows(int(i % lanes), int(lanes)), triangle.payload, isTwoSided(item, t), projected, view);
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

void rasterItem(WorkItem item, Share share, View view)
{
	bool projected = storeVertices(item, view);
	rasterTriangles(item, share, projected, view);
	barrier();
	if (raster_any_wide != 0u)
		rasterWideTriangles(item, projected, view);
	barrier();
}

void rasterNumbered(uint number, Share share, uint cluster_count, View view)
{
	beginRaster();
	if (SHARES_WORK && gl_LocalInvocationIndex == 0u)
		sampled_box_px = 0u;
	rasterItem(workItem(args.inputs, args.full_clusters, args.batches, number, cluster_count), share, view);
}

void main()
{
	if (args.counts.at[0].overflow != 0u)
		return;
	View view = frame_view;
	PhaseItems items = phaseItems();
	bool is_rest = SMALL_FIRST && args.phase == PHASE_FIRST;
	uint count = is_rest ? args.counts.at[0].left_items : items.count;
	uint shares = SHARES_WORK ? clamp(min(gl_NumWorkGroups.x, FILLING_WORKGROUPS) / max(count, 1u), 1u, MOST_SHARES) : 1u;
	for (uint i = gl_WorkGroupID.x; i < count * shares; i += gl_NumWorkGroups.x)
	{
		uint index = i / shares;
		uint number = is_rest ? args.left_items.at[index] : itemNumber(items, index);
		if (is_rest || isOfPhase(items, index))
			rasterNumbered(number, Share(i % shares, shares), items.clusters, view);
	}
}
