// cluster_classify: decide, per visible cluster, what each triangle becomes.
//
//   in   visible_clusters   ClusterRef[]       from cluster_cull
//   in   cluster_bounds     DisplacedBounds[]  only with culling: triangles out of view become nothing
//   out  full_clusters      FullCluster[]      visible clusters whose factors are all 1: drawn as stored
//   out  split_triangles    DomainTriangle[]   some factor exceeds the table: level 0 of triangle_split
//   out  part_triangles     DomainTriangle[]   fits the table: to batch_parts
//
// One workgroup takes one cluster at a time; lanes stride over its vertices and triangles, so any workgroup size works.
// Appends are gathered per workgroup: one atomic per list. `wanted` keeps counting past capacity; nothing is written there,
// and nothing of it is drawn: rate_search lists everything again at a coarser rate (C2).
// Host: src/pipeline/tessellation/cluster_classify.cpp   Test: tests/gpu/tessellation_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "tessellation/cluster_classify.h"
#include "lib/classify.glsl"
#include "lib/full_clusters.glsl"
#include "lib/occlusion.glsl"

layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Args { ClusterClassifyArgs args; };

shared vec3 relative[128];
shared uint decisions[128];
shared uint part_count;
shared uint split_count;
shared uint tessellated;
shared uint first_part;
shared uint first_split;

const uint ALL_ONE = 0x111u;

void placeVertices(ClusterRecord cluster, Placement placement)
{
	for (uint v = gl_LocalInvocationIndex; v < clusterVertices(cluster); v += gl_WorkGroupSize.x)
		relative[v] = placed(placement, args.positions.at[cluster.first_vertex + v]);
}

ClassifiedCorner cornerOf(uint triangle, uint corner)
{
	return ClassifiedCorner(domainCorner(corner), relative[triangleVertex(triangle, corner)]);
}

void decideTriangles(ClusterRecord cluster, Placement placement, PlacedReach reach, View view)
{
	for (uint t = gl_LocalInvocationIndex; t < clusterTriangles(cluster); t += gl_WorkGroupSize.x)
	{
		uint triangle = args.triangles.at[cluster.first_triangle + t];
		ClassifiedCorner p = cornerOf(triangle, 0u), q = cornerOf(triangle, 1u), r = cornerOf(triangle, 2u);
		EdgeBase base = EdgeBase(cluster.first_triangle + t, placement.inverse_scale_squared, placement.triangle_reach,
		                         placement.hidden_squared);
		uint decision = decideTriangle(base, p, q, r, view, args.rule);
		if (decision != ALL_ONE)
			tessellated = 1u;
		if (isOutOfView(p, q, r, reach, args.cull_frustum, view))
			decision = DECISION_CULLED;
		// The place in the workgroup's part of the list rides in the upper bits.
		uint place = 0u;
		if (decision != DECISION_CULLED)
			place = (decision & DECISION_SPLIT) != 0u ? atomicAdd(split_count, 1u) : atomicAdd(part_count, 1u);
		decisions[t] = decision | (place << 16);
	}
}

bool isShared(ClusterRef ref) { return SHARES_STRUCTURES && args.shared_instances.at[ref.instance] != NOT_SHARED; }

// Bounds are there when something is culled. Instances that share a structure have been found to be full as a whole.
bool isFullByBounds(ClusterRef ref, Placement placement, View view)
{
	if (isShared(ref))
		return true;
	return HAS_CULLING && !HAS_DETAIL && !HAS_DISPLACED_EDGES && allFactorsAreOne(args.cluster_bounds.at[ref.cluster], placement, view);
}

uint fullPhase(uint index)
{
	ClusterRef ref = args.visible_clusters.at[index];
	if (isShared(ref))
		return PHASE_SHARED;
	if (!HAS_OCCLUSION)
		return PHASE_FIRST;
	return wasHidden(args.cluster_bounds.at[ref.cluster], args.instances.at[ref.instance]) ? PHASE_HIDDEN : PHASE_FIRST;
}

void reserve(ClusterRecord cluster, uint index)
{
	if (tessellated == 0u)
	{
		uint slot = reserveEntries(args.heads, LIST_FULL_CLUSTERS, 1u);
		listFullCluster(args.heads, args.counts, args.full_clusters, slot, index, cluster, fullPhase(index));
		return;
	}
	if (part_count > 0u)
		first_part = reserveEntries(args.heads, LIST_PART_TRIANGLES, part_count);
	if (split_count > 0u)
	{
		first_split = atomicAdd(args.counts.at[0].split_count[0], split_count);
		atomicAdd(args.heads.at[LIST_SPLIT_TRIANGLES].wanted, split_count);
	}
}

void writeTriangles(ClusterRecord cluster, uint index)
{
	uint part_capacity = args.heads.at[LIST_PART_TRIANGLES].capacity;
	uint split_capacity = args.heads.at[LIST_SPLIT_TRIANGLES].capacity;
	for (uint t = gl_LocalInvocationIndex; t < clusterTriangles(cluster); t += gl_WorkGroupSize.x)
	{
		uint decision = decisions[t] & 0xffffu;
		uint place = decisions[t] >> 16;
		if (decision == DECISION_CULLED)
			continue;
		DomainTriangle record = decidedTriangle(decision, domainCorner(0u), domainCorner(1u), domainCorner(2u), index, t);
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
	uint cluster_count = entriesOf(args.heads, LIST_VISIBLE_CLUSTERS);
	for (uint index = gl_WorkGroupID.x; index < cluster_count; index += gl_NumWorkGroups.x)
	{
		ClusterRef ref = args.visible_clusters.at[index];
		ClusterRecord cluster = args.clusters.at[ref.cluster];
		View view = frame_view;
		if (gl_LocalInvocationIndex == 0u)
		{
			part_count = 0u;
			split_count = 0u;
			tessellated = 0u;
		}
		Placement placement = placementForEdges(args.instances.at[ref.instance], ref.instance, frame_surface, view);
		// One cluster, one answer: all lanes come by the same barriers.
		if (!isFullByBounds(ref, placement, view))
		{
			PlacedReach reach;
			if (HAS_CULLING)
				reach = placedReach(args.cluster_bounds.at[ref.cluster], placement, view);
			placeVertices(cluster, placement);
			barrier();
			decideTriangles(cluster, placement, reach, view);
		}
		barrier();
		if (gl_LocalInvocationIndex == 0u)
			reserve(cluster, index);
		barrier();
		if (tessellated != 0u)
			writeTriangles(cluster, index);
		barrier();
	}
}
