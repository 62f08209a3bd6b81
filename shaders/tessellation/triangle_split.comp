// triangle_split: cut the split triangles of one level by their patterns and decide each child anew.
//
//   in   split_triangles   DomainTriangle[]   entries of this level: after those of the levels before it
//   out  split_triangles   DomainTriangle[]   children that still exceed the table: the next level
//   out  part_triangles    DomainTriangle[]   children that fit: to batch_parts
//
// One dispatch per level, with a barrier between: no workgroup waits for another. One workgroup takes SPLITS_PER_GROUP
// triangles at a time and one lane a child: most triangles have few, so that a workgroup each would mostly wait. Neighbouring
// children compute their common corners twice; they get the same, since interior points of a pattern are points of a split
// triangle exactly as of a part triangle.
// Host: src/pipeline/tessellation/triangle_split.cpp   Test: tests/gpu/tessellation_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x_id = 0) in;
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "tessellation/triangle_split.h"
#include "lib/classify.glsl"
#include "lib/lists.glsl"
#include "shared/surface.h"

layout(push_constant, scalar) uniform Args { TriangleSplitArgs args; };

const uint SPLITS_PER_GROUP = 24u;  // with five children each, as most have, one turn of 128 threads

shared DomainTriangle split_records[SPLITS_PER_GROUP];
shared PatternRange split_patterns[SPLITS_PER_GROUP];
shared uint split_flags[SPLITS_PER_GROUP];
shared uint split_triangles[SPLITS_PER_GROUP];  // global index of the base triangle
shared vec3 split_positions[3u * SPLITS_PER_GROUP];
shared Placement split_placements[SPLITS_PER_GROUP];
shared PlacedReach split_reaches[SPLITS_PER_GROUP];
// Children of the splits before each; the last entry: of all.
shared uint child_counts[SPLITS_PER_GROUP];
shared uint child_sums[SPLITS_PER_GROUP + 1u];
shared uint part_count;
shared uint split_count;
shared uint first_part;
shared uint first_split;

// First entry of a level in split_triangles.
uint levelBegin(uint level)
{
	uint begin = 0u;
	for (uint i = 0u; i < level; ++i)
		begin += args.counts.at[0].split_count[i];
	return begin;
}

void loadSplit(uint lane, uint index)
{
	DomainTriangle record = args.split_triangles.at[index];
	DomainPiece piece = unpackTriangle(record);
	ClusterRef ref = args.visible_clusters.at[piece.visible_cluster];
	ClusterRecord cluster = args.clusters.at[ref.cluster];
	Placement placement = placementForEdges(args.instances.at[ref.instance], ref.instance, frame_surface, frame_view);
	uint triangle = args.triangles.at[cluster.first_triangle + piece.triangle];
	PatternRange pattern = args.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
	for (uint corner = 0u; corner < 3u; ++corner)
		split_positions[3u * lane + corner] = args.positions.at[cluster.first_vertex + triangleVertex(triangle, corner)];
	split_records[lane] = record;
	split_patterns[lane] = pattern;
	split_flags[lane] = triangleEdgeFlags(triangle);
	split_triangles[lane] = cluster.first_triangle + piece.triangle;
	split_placements[lane] = placement;
	if (HAS_CULLING)
		split_reaches[lane] = placedReach(args.cluster_bounds.at[ref.cluster], placement, frame_view);
	child_counts[lane] = patternTriangles(pattern);
}

// Sums of the children before each of `count` splits.
void sumChildren(uint lane, uint count)
{
	uint sum = 0u;
	for (uint i = 0u; i < SPLITS_PER_GROUP; ++i)
		sum += i < min(lane, count) ? child_counts[i] : 0u;
	child_sums[lane] = sum;
}

uint owningSplit(uint child)
{
	uint low = 0u;
	for (uint step = 16u; step > 0u; step /= 2u)
		if (low + step < SPLITS_PER_GROUP && child_sums[low + step] <= child)
			low += step;
	return low;
}

struct Child
{
	uint decision;
	uint owner;
	DomainPoint domain[3];
};

Child decideChild(uint index)
{
	View view = frame_view;
	Child child;
	child.owner = owningSplit(index);
	DomainPiece piece = unpackTriangle(split_records[child.owner]);
	PatternRange pattern = split_patterns[child.owner];
	Placement placement = split_placements[child.owner];
	uvec3 vertices = patternTriangle(index - child_sums[child.owner], pattern, args.table, piece.mirror);
	vec3 relative[3];
	for (uint i = 0u; i < 3u; ++i)
	{
		child.domain[i] = patternPoint(piece, vertices[i], pattern, args.table, split_flags[child.owner]);
		relative[i] = placed(placement, weightedVec3(split_positions[3u * child.owner], split_positions[3u * child.owner + 1u],
		                                             split_positions[3u * child.owner + 2u], domainWeights(child.domain[i])));
	}
	ClassifiedCorner p = ClassifiedCorner(child.domain[0], relative[0]);
	ClassifiedCorner q = ClassifiedCorner(child.domain[1], relative[1]);
	ClassifiedCorner r = ClassifiedCorner(child.domain[2], relative[2]);
	PlacedReach reach;
	if (HAS_CULLING)
		reach = split_reaches[child.owner];
	EdgeBase base = EdgeBase(split_triangles[child.owner], placement.inverse_scale_squared, placement.triangle_reach,
	                         placement.hidden_squared);
	bool culled = isOutOfView(p, q, r, reach, args.cull_frustum, view);
	child.decision = culled ? DECISION_CULLED : decideTriangle(base, p, q, r, view, args.rule);
	return child;
}

void reserve(uint next_begin)
{
	if (part_count > 0u)
		first_part = reserveEntries(args.heads, LIST_PART_TRIANGLES, part_count);
	if (split_count == 0u)
		return;
	atomicAdd(args.heads.at[LIST_SPLIT_TRIANGLES].wanted, split_count);
	first_split = next_begin + atomicAdd(args.counts.at[0].split_count[args.level + 1u], split_count);
}

void writeChild(Child child, uint place)
{
	DomainPiece parent = unpackTriangle(split_records[child.owner]);
	DomainTriangle record =
		decidedTriangle(child.decision, child.domain[0], child.domain[1], child.domain[2], parent.visible_cluster, parent.triangle);
	uint split_capacity = args.last_level != 0u ? 0u : args.heads.at[LIST_SPLIT_TRIANGLES].capacity;
	if ((child.decision & DECISION_SPLIT) != 0u)
	{
		if (first_split + place < split_capacity)
			args.split_triangles.at[first_split + place] = record;
	}
	else if (first_part + place < args.heads.at[LIST_PART_TRIANGLES].capacity)
		args.part_triangles.at[first_part + place] = record;
}

// Children from `first`, one a lane.
void cutChildren(uint first, uint end, uint next_begin)
{
	uint index = first + gl_LocalInvocationIndex;
	Child child;
	child.decision = DECISION_CULLED;
	if (index < end)
		child = decideChild(index);
	if (gl_LocalInvocationIndex == 0u)
	{
		part_count = 0u;
		split_count = 0u;
	}
	barrier();
	uint place = 0u;
	if (child.decision != DECISION_CULLED)
		place = (child.decision & DECISION_SPLIT) != 0u ? atomicAdd(split_count, 1u) : atomicAdd(part_count, 1u);
	barrier();
	if (gl_LocalInvocationIndex == 0u)
		reserve(next_begin);
	barrier();
	if (child.decision != DECISION_CULLED)
		writeChild(child, place);
}

void main()
{
	uint lane = gl_LocalInvocationIndex;
	uint begin = levelBegin(args.level);
	uint next_begin = begin + args.counts.at[0].split_count[args.level];
	uint end = min(next_begin, args.heads.at[LIST_SPLIT_TRIANGLES].capacity);
	for (uint first = begin + gl_WorkGroupID.x * SPLITS_PER_GROUP; first < end; first += gl_NumWorkGroups.x * SPLITS_PER_GROUP)
	{
		uint count = min(SPLITS_PER_GROUP, end - first);
		for (uint i = lane; i < count; i += gl_WorkGroupSize.x)
			loadSplit(i, first + i);
		barrier();
		for (uint i = lane; i <= SPLITS_PER_GROUP; i += gl_WorkGroupSize.x)
			sumChildren(i, count);
		barrier();
		uint children = child_sums[SPLITS_PER_GROUP];
		for (uint child = 0u; child < children; child += gl_WorkGroupSize.x)
			cutChildren(child, children, next_begin);
		barrier();
	}
}
