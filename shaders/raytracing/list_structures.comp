// list_structures: where the addresses of each instance's clusters begin, and whether anything is built at all.
//
//   in   cluster_counts      ClusterCounts        from list_clusters
//   out  instance_clusters   InstanceClusters[]   ranges, and which structure an instance gets
//   out  ray_references      StructureInfo[]      one per instance that has clusters; in any order
//
// One thread an instance; ranges are taken once per workgroup.
// Host: src/pipeline/raytracing/list_clusters.cpp   Test: tests/gpu/raytracing/clusters_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x_id = 0) in;
#include "raytracing/cluster_lists.h"

layout(push_constant, scalar) uniform Args { ClusterWorkArgs args; };

shared uint structure_sum;
shared uint reference_sum;
shared uint first_structure;
shared uint first_reference;

bool everythingFits(ClusterWork work)
{
	for (uint kind = 0u; kind < RESERVED_KINDS; ++kind)
		if (work.counts.at[0].wanted[kind] > work.reserved[kind])
			return false;
	return true;
}

void listInstance(ClusterWork work, uint instance, uint count)
{
	uint lane = gl_LocalInvocationIndex;
	if (lane == 0u)
	{
		structure_sum = 0u;
		reference_sum = 0u;
	}
	barrier();
	uint structure = count > 0u ? atomicAdd(structure_sum, 1u) : 0u;
	uint first = atomicAdd(reference_sum, count);
	barrier();
	if (lane == 0u && structure_sum > 0u)
	{
		first_structure = atomicAdd(work.counts.at[0].structures, structure_sum);
		first_reference = atomicAdd(work.counts.at[0].references, reference_sum);
	}
	barrier();
	if (instance < work.scene_instances)
	{
		work.instances.at[instance].first = first_reference + first;
		work.instances.at[instance].structure = count > 0u ? first_structure + structure : NO_STRUCTURE;
	}
	if (count > 0u)
		work.structures.at[first_structure + structure] = StructureInfo(count, 8u, uint64_t(work.references) + 8u * uint64_t(first_reference + first));
	barrier();
}

void main()
{
	ClusterWork work = args.work.at[0];
	bool fits = everythingFits(work);
	if (gl_GlobalInvocationID.x == 0u && fits)
	{
		work.counts.at[0].built_instantiations = work.counts.at[0].wanted[RESERVED_INSTANTIATIONS];
		work.counts.at[0].built_transients = work.counts.at[0].wanted[RESERVED_TRANSIENTS];
	}
	uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
	for (uint begin = gl_WorkGroupID.x * gl_WorkGroupSize.x; begin < work.scene_instances; begin += stride)
	{
		uint instance = begin + gl_LocalInvocationIndex;
		uint count = fits && instance < work.scene_instances ? work.instances.at[instance].count : 0u;
		listInstance(work, instance, count);
	}
}
