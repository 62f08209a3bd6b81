// raster_small: as raster_micro, for items within the guard band whose parts span less than 128 pixels; leaves the others, and those with
// a triangle that is too large for one lane, to raster_micro, whose code for them would cost every workgroup registers and shared memory.
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

// A vertex is two words: where it is on screen relative to its part's first vertex, 16 bits each, and depth.
shared uint vertex_offsets[RASTER_BATCH_VERTICES];
shared float vertex_depths[RASTER_BATCH_VERTICES];
shared ivec2 part_origins[RASTER_BATCH_PARTS];  // of a full cluster: the first
shared uint has_outside;  // 1: a vertex does not fit that, or lies outside the guard band
shared uint has_large;    // 1: so does a triangle

uint ownerOf(WorkItem item, uint vertex) { return HAS_TESSELLATION && item.is_batch ? vertexOwner(vertex) : 0u; }

bool isFirst(WorkItem item, uint vertex, uint owner)
{
	return vertex == (HAS_TESSELLATION && item.is_batch ? part_sums[owner] & 0xffffu : 0u);
}

// Where vertex `index` is on screen. Only good if it is inside the guard band.
ivec2 storeDepth(WorkItem item, uint index, View view)
{
	vec4 clip = clipPosition(itemVertex(args.inputs, item, index), view);
	if (!insideGuard(clip, view))
	{
		has_outside = 1u;
		return ivec2(0);
	}
	ScreenVertex screen = toScreen(clip, view);
	vertex_depths[index] = screen.depth;
	uint owner = ownerOf(item, index);
	if (isFirst(item, index, owner))
		part_origins[owner] = screen.position;
	return screen.position;
}

void storeOffset(WorkItem item, uint index, ivec2 position)
{
	ivec2 offset = position - part_origins[ownerOf(item, index)];
	if (any(notEqual(offset, bitfieldExtract(offset, 0, 16))))
		has_outside = 1u;
	vertex_offsets[index] = (uint(offset.x) & 0xffffu) | (uint(offset.y) << 16);
}

// Ends with a barrier. A part's first vertex comes before its others: in the same turn or in one before.
void storeVertices(WorkItem item, View view)
{
	for (uint first = 0u; first < item.vertex_count; first += gl_WorkGroupSize.x)
	{
		uint index = first + gl_LocalInvocationIndex;
		bool is_one = index < item.vertex_count;
		ivec2 position = is_one ? storeDepth(item, index, view) : ivec2(0);
		barrier();
		if (is_one)
			storeOffset(item, index, position);
	}
	barrier();
}

ScreenVertex vertexAt(uint index, ivec2 origin)
{
	int offsets = int(vertex_offsets[index]);
	return ScreenVertex(origin + ivec2(bitfieldExtract(offsets, 0, 16), offsets >> 16), vertex_depths[index]);
}

void rasterTriangles(WorkItem item, View view)
{
	VisibilityRef target = VisibilityRef(args.visibility);
	for (uint t = gl_LocalInvocationIndex; t < item.triangle_count; t += gl_WorkGroupSize.x)
	{
		MicroTriangle triangle = itemTriangle(args.inputs, item, t);
		uvec3 corners = triangle.vertices;
		ivec2 origin = part_origins[HAS_TESSELLATION && item.is_batch ? triangleOwner(t) : 0u];
		if (!rasterUnlessLarge(target, vertexAt(corners.x, origin), vertexAt(corners.y, origin), vertexAt(corners.z, origin), triangle.payload,
		                       isTwoSided(item, t), view))
			has_large = 1u;
	}
}

// Ends with a barrier.
void rasterNumbered(uint number, uint cluster_count, View view)
{
	bool is_first_lane = gl_LocalInvocationIndex == 0u;
	if (is_first_lane)
	{
		has_outside = 0u;
		has_large = 0u;
	}
	WorkItem item = workItem(args.inputs, args.full_clusters, args.batches, number, cluster_count);
	storeVertices(item, view);
	if (has_outside == 0u)
		rasterTriangles(item, view);
	barrier();
	if (is_first_lane && (has_outside | has_large) != 0u)
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
