// cluster_cull: test every cluster of the visible instances against the frustum and by its normal cone.
//
//   in   cluster_groups     ClusterGroup[]      from instance_classify
//   in   cluster_bounds     DisplacedBounds[]   only with culling
//   in   shared_instances   uint[]              only with structures that instances share
//   out  visible_clusters   ClusterRef[]        to cluster_classify
//   out  shared_clusters    uint[]              likewise, with primary rays: per cluster of such an instance, its place in visible_clusters
//   out  full_clusters      FullCluster[]           only when nothing can be tessellated: every visible cluster, to draw_clusters
//
// One workgroup takes one group at a time, one lane a cluster. Conservative: a culled cluster cannot touch a pixel (C3).
// Host: src/pipeline/culling/cluster_cull.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "culling/cluster_cull.h"
#include "lib/full_clusters.glsl"
#include "lib/occlusion.glsl"

layout(local_size_x = CLUSTER_GROUP_SIZE) in;
layout(push_constant, scalar) uniform Args { ClusterCullArgs args; };

shared uint visible_count;
shared uint first_visible;
shared uint first_full;

// True when every triangle shows its back to the eye: the cone of normals around the bounding sphere of the box.
bool isBackFacing(DisplacedBounds bounds, InstanceRecord instance, Placement placement, View view)
{
	// A cone is of what heights leave in place; an offset moves what has directions.
	bool moves = view.displacement_offset != 0.0 && any(notEqual(bounds.direction_low, bounds.direction_high));
	if (moves || bounds.cone_cutoff > 1.0 || view.distance_weight == 0.0)
		return false;
	vec3 middle = (bounds.low + bounds.high) * 0.5;
	float radius = length(bounds.high - middle);
	// The eye in mesh space: the test is about the mesh's own plane sides, which no affine transform changes.
	mat3 linear = transpose(mat3(placement.row0, placement.row1, placement.row2));
	float volume = abs(determinant(linear));
	float size = length(linear[0]) * length(linear[1]) * length(linear[2]);
	if (!(volume > size * 1e-3))
		return false;
	vec3 eye = inverse(linear) * -placement.translation;
	vec3 from_eye = middle - eye;
	float distance_to_eye = length(from_eye);
	return dot(bounds.cone_axis, from_eye) * (1.0 - 1e-4) >= bounds.cone_cutoff * distance_to_eye + radius + distance_to_eye * 1e-4;
}

bool isVisible(ClusterGroup group, uint cluster)
{
	if (!HAS_CULLING)
		return true;
	View view = frame_view;
	InstanceRecord instance = args.instances.at[group.instance];
	DisplacedBounds bounds = args.cluster_bounds.at[cluster];
	Placement placement = placementOf(instance, view);
	if (args.cull_frustum != 0u && !boxMayBeVisible(displacedBox(bounds, view.displacement_scale, view.displacement_offset), placement, view))
		return false;
	return args.cull_backface == 0u || !isBackFacing(bounds, instance, placement, view);
}

// Where primary rays that meet a cluster in a shared structure find it; NO_INDEX: it is listed nowhere.
void placeShared(ClusterGroup group, uint cluster, uint place)
{
	uint first = args.meshes.at[args.instances.at[group.instance].mesh].first_cluster;
	args.shared_clusters.at[args.shared_instances.at[group.instance] + cluster - first] = place;
}

uint fullPhase(ClusterGroup group, uint cluster, bool is_shared)
{
	if (is_shared)
		return PHASE_SHARED;
	return HAS_OCCLUSION && wasHidden(args.cluster_bounds.at[cluster], args.instances.at[group.instance]) ? PHASE_HIDDEN : PHASE_FIRST;
}

void main()
{
	uint group_count = entriesOf(args.heads, LIST_CLUSTER_GROUPS);
	for (uint index = gl_WorkGroupID.x; index < group_count; index += gl_NumWorkGroups.x)
	{
		ClusterGroup group = args.cluster_groups.at[index];
		if (gl_LocalInvocationIndex == 0u)
			visible_count = 0u;
		barrier();

		uint cluster = group.first_cluster + gl_LocalInvocationIndex;
		bool visible = gl_LocalInvocationIndex < group.cluster_count && isVisible(group, cluster);
		uint place = visible ? atomicAdd(visible_count, 1u) : 0u;
		barrier();

		if (gl_LocalInvocationIndex == 0u && visible_count > 0u)
		{
			first_visible = reserveEntries(args.heads, LIST_VISIBLE_CLUSTERS, visible_count);
			if (args.emit_full != 0u)
				first_full = reserveEntries(args.heads, LIST_FULL_CLUSTERS, visible_count);
		}
		barrier();

		bool is_shared = SHARES_STRUCTURES && args.shared_instances.at[group.instance] != NOT_SHARED;
		if (is_shared && gl_LocalInvocationIndex < group.cluster_count && uint64_t(args.shared_clusters) != 0ul)
			placeShared(group, cluster, visible ? first_visible + place : NO_INDEX);
		if (visible && first_visible + place < args.heads.at[LIST_VISIBLE_CLUSTERS].capacity)
		{
			args.visible_clusters.at[first_visible + place] = ClusterRef(group.instance, cluster);
			if (args.emit_full != 0u)
				listFullCluster(args.heads, args.counts, args.full_clusters, first_full + place, first_visible + place, args.clusters.at[cluster],
				                fullPhase(group, cluster, is_shared));
		}
		barrier();
	}
}
