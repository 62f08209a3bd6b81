// cluster_id.h: what a cluster that rays meet is: the 32 bits that hits are told, with the number of the triangle within the cluster.
#ifndef TESSERA_SHARED_CLUSTER_ID_H
#define TESSERA_SHARED_CLUSTER_ID_H
#include "shared/lang.h"

SHARED_BEGIN

// Kinds, in the two upper bits; what the lower 30 are an index into.
#define CLUSTER_OF_FULL 0u   // a full cluster: into visible_clusters
#define CLUSTER_OF_PART 1u   // a part triangle, made from its pattern: into part_triangles
#define CLUSTER_OF_UNITS 2u  // triangles of factor 1 of one visible cluster: where their payloads begin
#define CLUSTER_OF_GROUP 3u  // part triangles with factors up to 2, of one instance: likewise
#define CLUSTER_KINDS 4u

SHARED_FN uint packClusterId(uint kind, uint index)
{
	return (kind << 30) | index;
}
SHARED_FN uint clusterKind(uint id)
{
	return id >> 30;
}
SHARED_FN uint clusterIndex(uint id)
{
	return id & 0x3fffffffu;
}

SHARED_END

#endif
