// insert_clusters: put the address of every cluster into the list of its instance.
//
//   in   ray_inputs          ClusterPlace[], DeviceAddress[]   of instantiations and of transients
//   in   instance_clusters   InstanceClusters[]
//   out  ray_references      DeviceAddress[]                   what bottom-level structures are built of
//
// One thread a cluster. Clusters are not built yet, but their places are decided.
// Host: src/pipeline/raytracing/list_clusters.cpp   Test: tests/gpu/raytracing/clusters_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x_id = 0) in;
#include "raytracing/cluster_lists.h"

layout(push_constant, scalar) uniform Args { ClusterWorkArgs args; };

void insert(ClusterWork work, ClusterPlace at, uint64_t address)
{
	work.references.at[work.instances.at[at.instance].first + at.place].bytes = address;
}

void main()
{
	ClusterWork work = args.work.at[0];
	uint instantiations = work.counts.at[0].built_instantiations;
	uint count = instantiations + work.counts.at[0].built_transients;
	uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
	for (uint i = gl_GlobalInvocationID.x; i < count; i += stride)
	{
		uint transient = i - instantiations;
		if (i < instantiations)
			insert(work, work.instantiation_places.at[i], work.instantiation_destinations.at[i].bytes);
		else
			insert(work, work.transient_places.at[transient], work.transient_destinations.at[transient].bytes);
	}
}
