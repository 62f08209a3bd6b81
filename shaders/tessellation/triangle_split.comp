// triangle_split: cut the split triangles of one level by their patterns and decide each child anew.
//
//   in   split_triangles   DomainTriangle[]   entries of this level: after those of the levels before it
//   out  split_triangles   DomainTriangle[]   children that still exceed the table: the next level
//   out  part_triangles    DomainTriangle[]   children that fit: to batch_parts
//
// One dispatch per level, with a barrier between: no workgroup waits for another. One workgroup takes SPLITS_PER_GROUP
// triangles at a time: most have few children, so that a workgroup each would mostly wait. Of as many of them as there is room
// for, lanes first place the points that the pattern makes, one each, then take one child each.
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

const uint SPLITS_PER_GROUP = 32u;
const uint MOST_POINTS = 384u;  // of several splits together; a pattern has BATCH_MAX_VERTICES at most

shared DomainTriangle split_records[SPLITS_PER_GROUP];
shared PatternRange split_patterns[SPLITS_PER_GROUP];
shared uint split_flags[SPLITS_PER_GROUP];
shared vec3 split_positions[3u * SPLITS_PER_GROUP];
shared Placement split_placements[SPLITS_PER_GROUP];
shared PlacedReach split_reaches[SPLITS_PER_GROUP];
shared uint split_inside[SPLITS_PER_GROUP];  // 1: nothing of it can be out of view
// Children in the low, points in the high half: of each, and of those before each; the last entry: of all.
shared uint split_counts[SPLITS_PER_GROUP];
shared uint split_sums[SPLITS_PER_GROUP + 1u];
// Points at hand: domain points, and undisplaced positions relative to the eye.
shared DomainPoint points[MOST_POINTS];
shared float point_x[MOST_POINTS];
shared float point_y[MOST_POINTS];
shared float point_z[MOST_POINTS];
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

vec3 splitPosition(uint split, DomainPoint point)
{
	return weightedVec3(split_positions[3u * split], split_positions[3u * split + 1u], split_positions[3u * split + 2u], domainWeights(point));
}

bool splitIsInside(uint split, DomainPiece piece)
{
	Placement placement = split_placements[split];
	return pieceIsInside(placed(placement, splitPosition(split, piece.c0)), placed(placement, splitPosition(split, piece.c1)),
	                     placed(placement, splitPosition(split, piece.c2)), split_reaches[split], frame_view);
}

void loadSplit(uint lane, uint index)
{
	DomainTriangle record = args.split_triangles.at[index];
	DomainPiece piece = unpackTriangle(record);
	ClusterRef ref = args.visible_clusters.at[piece.visible_cluster];
	ClusterRecord cluster = args.clusters.at[ref.cluster];
	Placement placement = placementOf(args.instances.at[ref.instance], frame_view);
	uint triangle = frame_surface.triangles.at[cluster.first_triangle + piece.triangle];
	PatternRange pattern = args.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
	for (uint corner = 0u; corner < 3u; ++corner)
		split_positions[3u * lane + corner] = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, corner)];
	split_records[lane] = record;
	split_patterns[lane] = pattern;
	split_flags[lane] = triangleEdgeFlags(triangle);
	split_placements[lane] = placement;
	if (HAS_CULLING)
	{
		split_reaches[lane] = placedReach(args.cluster_bounds.at[ref.cluster], placement, frame_view);
		split_inside[lane] = splitIsInside(lane, piece) ? 1u : 0u;
	}
	split_counts[lane] = patternTriangles(pattern) | (patternVertices(pattern) << 16);
}

// Sums of what comes before each of `count` splits.
void sumCounts(uint lane, uint count)
{
	uint sum = 0u;
	for (uint i = 0u; i < SPLITS_PER_GROUP; ++i)
		sum += i < min(lane, count) ? split_counts[i] : 0u;
	split_sums[lane] = sum;
}

uint childrenBefore(uint split) { return split_sums[split] & 0xffffu; }
uint pointsBefore(uint split) { return split_sums[split] >> 16; }

// The last split that has at most `count` children, or points (shift 16), before it.
uint owningSplit(uint count, uint shift)
{
	uint low = 0u;
	for (uint step = SPLITS_PER_GROUP / 2u; step > 0u; step /= 2u)
		if (((split_sums[low + step] >> shift) & 0xffffu) <= count)
			low += step;
	return low;
}

// End of the splits from `begin` whose points there is room for: one at least.
uint pointsEnd(uint begin, uint count)
{
	uint end = begin + 1u;
	while (end < count && pointsBefore(end + 1u) - pointsBefore(begin) <= MOST_POINTS)
		++end;
	return end;
}

void placePoints(uint begin, uint end)
{
	uint first = pointsBefore(begin);
	for (uint index = first + gl_LocalInvocationIndex; index < pointsBefore(end); index += gl_WorkGroupSize.x)
	{
		uint owner = owningSplit(index, 16u);
		DomainPoint point =
			patternPoint(unpackTriangle(split_records[owner]), index - pointsBefore(owner), split_patterns[owner], args.table, split_flags[owner]);
		vec3 relative = placed(split_placements[owner], splitPosition(owner, point));
		points[index - first] = point;
		point_x[index - first] = relative.x;
		point_y[index - first] = relative.y;
		point_z[index - first] = relative.z;
	}
}

ClassifiedCorner cornerAt(uint index) { return ClassifiedCorner(points[index], vec3(point_x[index], point_y[index], point_z[index])); }

struct Child
{
	uint decision;
	uint owner;
	uvec3 corners;  // into points
};

// Child `index`; `first_point`: before the splits at hand.
Child decideChild(uint index, uint first_point)
{
	View view = frame_view;
	Child child;
	child.owner = owningSplit(index, 0u);
	uint mirror = unpackTriangle(split_records[child.owner]).mirror;
	child.corners = patternTriangle(index - childrenBefore(child.owner), split_patterns[child.owner], args.table, mirror);
	child.corners += pointsBefore(child.owner) - first_point;
	ClassifiedCorner p = cornerAt(child.corners.x), q = cornerAt(child.corners.y), r = cornerAt(child.corners.z);
	bool culled = HAS_CULLING && split_inside[child.owner] == 0u && isOutOfView(p, q, r, split_reaches[child.owner], args.cull_frustum, view);
	child.decision = culled ? DECISION_CULLED : decideTriangle(p, q, r, view, args.rule);
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
		decidedTriangle(child.decision, points[child.corners.x], points[child.corners.y], points[child.corners.z], parent.visible_cluster, parent.triangle);
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
void cutChildren(uint first, uint end, uint first_point, uint next_begin)
{
	uint index = first + gl_LocalInvocationIndex;
	Child child;
	child.decision = DECISION_CULLED;
	if (index < end)
		child = decideChild(index, first_point);
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
			sumCounts(i, count);
		barrier();
		for (uint from = 0u, to; from < count; from = to)
		{
			to = pointsEnd(from, count);
			placePoints(from, to);
			barrier();
			for (uint child = childrenBefore(from); child < childrenBefore(to); child += gl_WorkGroupSize.x)
				cutChildren(child, childrenBefore(to), pointsBefore(from), next_begin);
			barrier();
		}
	}
}
