// instance_classify: cull instances by their displaced bounds; cut what is left into groups of clusters.
//
//   in   instances        InstanceRecord[]
//   in   mesh_bounds      DisplacedBounds[]    only with frustum culling or shared structures
//   in   mesh_structures  addresses            of structures that instances share when rays are traced; only with those
//   out  cluster_groups   ClusterGroup[]       up to CLUSTER_GROUP_SIZE clusters of one visible instance: to cluster_cull
//
//   out  shared_instances uint[]               likewise: which instances do, and where their clusters begin in shared_clusters
//
// One thread takes one instance at a time. A frame drawn in several rounds (C2) takes every n-th group per round.
// Host: src/pipeline/culling/instance_classify.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "culling/instance_classify.h"
#include "lib/lists.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Args { InstanceClassifyArgs args; };

bool isVisible(InstanceRecord instance)
{
	if (!HAS_CULLING || args.cull_frustum == 0u)
		return true;
	View view = frame_view;
	Box box = displacedBox(args.mesh_bounds.at[instance.mesh], view.displacement_scale, view.displacement_offset);
	return boxMayBeVisible(box, placementOf(instance, view), view);
}

void appendGroups(uint index, MeshRecord mesh)
{
	uint groups = (mesh.cluster_count + CLUSTER_GROUP_SIZE - 1u) / CLUSTER_GROUP_SIZE;
	// The first group of this round: (instance * groups_per_mesh + group) mod round_count == round. With as many rounds as
	// groups there is one group in each, so enough rounds always fit.
	uint before = ((index % args.round_count) * (args.groups_per_mesh % args.round_count)) % args.round_count;
	uint offset = (args.round + args.round_count - before) % args.round_count;
	uint taken = groups > offset ? (groups - offset + args.round_count - 1u) / args.round_count : 0u;
	if (taken == 0u)
		return;
	uint slot = reserveEntries(args.heads, LIST_CLUSTER_GROUPS, taken);
	uint capacity = args.heads.at[LIST_CLUSTER_GROUPS].capacity;
	for (uint i = 0u; i < taken && slot + i < capacity; ++i)
	{
		uint first = (offset + i * args.round_count) * CLUSTER_GROUP_SIZE;
		ClusterGroup group;
		group.instance = index;
		group.first_cluster = mesh.first_cluster + first;
		group.cluster_count = min(mesh.cluster_count - first, CLUSTER_GROUP_SIZE);
		args.cluster_groups.at[slot + i] = group;
	}
}

// One answer for all of the instance's clusters.
uint sharedPlace(InstanceRecord instance, MeshRecord mesh)
{
	View view = frame_view;
	if (args.mesh_structures.at[instance.mesh] == uvec2(0u) ||
	    !mayShare(args.mesh_bounds.at[instance.mesh], placementOf(instance, view), args.sharing, view))
		return NOT_SHARED;
	atomicAdd(args.counts.at[0].shared_instances, 1u);
	return atomicAdd(args.counts.at[0].shared_clusters, mesh.cluster_count);
}

void main()
{
	uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
	for (uint index = gl_GlobalInvocationID.x; index < args.instance_count; index += stride)
	{
		InstanceRecord instance = args.instances.at[index];
		MeshRecord mesh = args.meshes.at[instance.mesh];
		bool is_visible = isVisible(instance);
		if (SHARES_STRUCTURES)
			args.shared_instances.at[index] = is_visible ? sharedPlace(instance, mesh) : NOT_SHARED;
		if (is_visible)
			appendGroups(index, mesh);
	}
}
