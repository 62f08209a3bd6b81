// Counting full clusters, wherever they are decided.
#ifndef TESSERA_LIB_FULL_CLUSTERS
#define TESSERA_LIB_FULL_CLUSTERS
#include "lib/lists.glsl"
#include "shared/geometry.h"

// The triangles of a full cluster count as micro-triangles; the indexed path also needs room to expand them.
void countFullCluster(ListHeadRef heads, FrameCountsRef counts, ClusterRecord cluster)
{
	atomicAdd(counts.at[0].full_cluster_triangles, clusterTriangles(cluster));
	if (COUNTS_EXPANDED)
	{
		reserveEntries(heads, LIST_EXPANDED_VERTICES, clusterVertices(cluster));
		reserveEntries(heads, LIST_EXPANDED_TRIANGLES, clusterTriangles(cluster));
	}
}

#endif
