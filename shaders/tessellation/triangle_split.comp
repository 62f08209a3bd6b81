// triangle_split: cut the split triangles of one level by their patterns and decide each child anew.
//
//   in   split_triangles   DomainTriangle[]   entries of this level: after those of the levels before it
//   out  split_triangles   DomainTriangle[]   children that still exceed the table: the next level
//   out  part_triangles    DomainTriangle[]   children that fit: to batch_parts
//
// One dispatch per level, with a barrier between: no workgroup waits for another. One workgroup takes one triangle at a
// time: its pattern's vertices first, then its children. Interior points of a pattern are points of a split triangle
// exactly as of a part triangle, so a child's corners are the same whoever computes them.
// Host: src/pipeline/tessellation/triangle_split.cpp   Test: tests/gpu/tessellation_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "tessellation/triangle_split.h"
#include "lib/classify.glsl"
#include "lib/lists.glsl"
#include "shared/surface.h"

layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Args { TriangleSplitArgs args; };

shared DomainPoint domains[BATCH_MAX_VERTICES];
shared vec3 relative[BATCH_MAX_VERTICES];
shared uint decisions[BATCH_MAX_TRIANGLES];
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

void placeVertices(DomainPiece piece, PatternRange pattern, ClusterRecord cluster, Placement placement)
{
	uint triangle = args.triangles.at[cluster.first_triangle + piece.triangle];
	vec3 p0 = args.positions.at[cluster.first_vertex + triangleVertex(triangle, 0u)];
	vec3 p1 = args.positions.at[cluster.first_vertex + triangleVertex(triangle, 1u)];
	vec3 p2 = args.positions.at[cluster.first_vertex + triangleVertex(triangle, 2u)];
	for (uint v = gl_LocalInvocationIndex; v < patternVertices(pattern); v += gl_WorkGroupSize.x)
	{
		domains[v] = patternPoint(piece, v, pattern, args.table, triangleEdgeFlags(triangle));
		relative[v] = placed(placement, weightedVec3(p0, p1, p2, domainWeights(domains[v])));
	}
}

ClassifiedCorner cornerOf(uint vertex) { return ClassifiedCorner(domains[vertex], relative[vertex]); }

void decideChildren(DomainPiece piece, PatternRange pattern, PlacedReach reach, View view)
{
	for (uint t = gl_LocalInvocationIndex; t < patternTriangles(pattern); t += gl_WorkGroupSize.x)
	{
		uvec3 corners = patternTriangle(t, pattern, args.table, piece.mirror);
		ClassifiedCorner p = cornerOf(corners.x), q = cornerOf(corners.y), r = cornerOf(corners.z);
		bool culled = isOutOfView(p, q, r, reach, args.cull_frustum, view);
		uint decision = culled ? DECISION_CULLED : decideTriangle(p, q, r, view, args.rule);
		uint place = 0u;
		if (decision != DECISION_CULLED)
			place = (decision & DECISION_SPLIT) != 0u ? atomicAdd(split_count, 1u) : atomicAdd(part_count, 1u);
		decisions[t] = decision | (place << 16);
	}
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

void writeChildren(DomainPiece piece, PatternRange pattern)
{
	uint part_capacity = args.heads.at[LIST_PART_TRIANGLES].capacity;
	uint split_capacity = args.last_level != 0u ? 0u : args.heads.at[LIST_SPLIT_TRIANGLES].capacity;
	for (uint t = gl_LocalInvocationIndex; t < patternTriangles(pattern); t += gl_WorkGroupSize.x)
	{
		uint decision = decisions[t] & 0xffffu;
		uint place = decisions[t] >> 16;
		if (decision == DECISION_CULLED)
			continue;
		uvec3 corners = patternTriangle(t, pattern, args.table, piece.mirror);
		DomainTriangle record = decidedTriangle(decision, domains[corners.x], domains[corners.y], domains[corners.z], piece.visible_cluster, piece.triangle);
		if ((decision & DECISION_SPLIT) != 0u)
		{
			if (first_split + place < split_capacity)
				args.split_triangles.at[first_split + place] = record;
		}
		else if (first_part + place < part_capacity)
			args.part_triangles.at[first_part + place] = record;
	}
}

void main()
{
	uint begin = levelBegin(args.level);
	uint next_begin = begin + args.counts.at[0].split_count[args.level];
	uint end = min(next_begin, args.heads.at[LIST_SPLIT_TRIANGLES].capacity);
	for (uint index = begin + gl_WorkGroupID.x; index < end; index += gl_NumWorkGroups.x)
	{
		DomainPiece piece = unpackTriangle(args.split_triangles.at[index]);
		ClusterRef ref = args.visible_clusters.at[piece.visible_cluster];
		View view = frame_view;
		PatternRange pattern = args.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
		if (gl_LocalInvocationIndex == 0u)
		{
			part_count = 0u;
			split_count = 0u;
		}
		Placement placement = placementOf(args.instances.at[ref.instance], view);
		PlacedReach reach;
		if (HAS_CULLING)
			reach = placedReach(args.cluster_bounds.at[ref.cluster], placement, view);
		placeVertices(piece, pattern, args.clusters.at[ref.cluster], placement);
		barrier();
		decideChildren(piece, pattern, reach, view);
		barrier();
		if (gl_LocalInvocationIndex == 0u)
			reserve(next_begin);
		barrier();
		writeChildren(piece, pattern);
		barrier();
	}
}
