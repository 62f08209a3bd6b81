// The payload of a hit in a cluster.
#ifndef TESSERA_LIB_CLUSTER_HIT
#define TESSERA_LIB_CLUSTER_HIT
#include "shared/cluster_id.h"
#include "shared/visibility.h"

// ClusterIDNV: glslang 12 has no name for it.
spirv_decorate(extensions = ["SPV_NV_cluster_acceleration_structure"], capabilities = [5437], 11, 5436) in int hit_cluster;

// `payloads`: of the triangles of transient clusters. `triangle`: within the cluster.
uint clusterPayload(uintRef payloads, uint id, uint triangle)
{
	uint index = clusterIndex(id);
	switch (clusterKind(id))
	{
	case CLUSTER_OF_FULL:
		return packPayload(KIND_FULL_CLUSTER, index, triangle);
	case CLUSTER_OF_PART:
		return packPayload(KIND_PART_TRIANGLE, index, triangle);
	default:
		return payloads.at[index + triangle];
	}
}

#endif
