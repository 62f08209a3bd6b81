// Listing full clusters, wherever they are decided.
#ifndef TESSERA_LIB_FULL_CLUSTERS
#define TESSERA_LIB_FULL_CLUSTERS
#include "lib/lists.glsl"
#include "shared/geometry.h"

// Counts a full cluster, takes its ranges and writes it to entry `slot` of full_clusters if there is room.
void listFullCluster(ListHeadRef heads, FrameCountsRef counts, FullClusterRef full_clusters, uint slot, uint visible_cluster, ClusterRecord cluster,
                     uint phase)
{
	FullCluster full = FullCluster(visible_cluster, 0u, phase);
	atomicAdd(counts.at[0].full_cluster_triangles, clusterTriangles(cluster));
	if (HAS_OCCLUSION && phase == PHASE_HIDDEN)
		atomicAdd(counts.at[0].hidden_clusters, 1u);
	// What rays meet in a shared structure is placed only for those who draw, and expanded for nobody.
	bool is_shared = SHARES_STRUCTURES && phase == PHASE_SHARED;
	if (KEEPS_VERTICES && !(is_shared && READS_BUFFER))
		full.first_vertex = reserveEntries(heads, LIST_MICRO_VERTICES, clusterVertices(cluster));
	if (EXPANDS_TRIANGLES && !is_shared)
		reserveEntries(heads, LIST_EXPANDED_TRIANGLES, clusterTriangles(cluster));
	if (slot < heads.at[LIST_FULL_CLUSTERS].capacity)
		full_clusters.at[slot] = full;
}

#endif
