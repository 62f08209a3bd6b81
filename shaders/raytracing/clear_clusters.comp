// clear_clusters: empty what the frame's clusters are counted by.
//
//   out  cluster_counts      ClusterCounts
//   out  instance_clusters   InstanceClusters[]   counts only
//
// Host: src/pipeline/raytracing/list_clusters.cpp   Test: tests/gpu/raytracing/clusters_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x_id = 0) in;
#include "raytracing/cluster_lists.h"

layout(push_constant, scalar) uniform Args { ClusterWorkArgs args; };

void main()
{
	ClusterWork work = args.work.at[0];
	uint thread = gl_GlobalInvocationID.x;
	uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
	for (uint kind = thread; kind < COUNTED_KINDS; kind += stride)
		work.counts.at[0].wanted[kind] = 0u;
	if (thread == 0u)
	{
		work.counts.at[0].built_instantiations = 0u;
		work.counts.at[0].built_transients = 0u;
		work.counts.at[0].structures = 0u;
		work.counts.at[0].references = 0u;
		work.counts.at[0].structure_units = 0u;
	}
	for (uint i = thread; i < work.scene_instances; i += stride)
		work.instances.at[i].count = 0u;
}
