// Arguments of rate_search, and the candidates that it chooses from.
#ifndef TESSERA_TESSELLATION_RATE_SEARCH_H
#define TESSERA_TESSELLATION_RATE_SEARCH_H
#include "shared/bounds.h"
#include "shared/edge_factor.h"
#include "shared/geometry.h"
#include "shared/lists.h"
#include "shared/pattern.h"
#include "shared/ray_sharing.h"

SHARED_BEGIN

// A candidate rate, rate x 2^(j/16): what the host says of it (shaders cannot compute it alike on every device) and what the
// device counts for it. The counts are 0 before and after every frame.
struct RateStep
{
	float rate_over_focal_squared;  // as in View
	float sample_over_focal_squared;
	FactorRule rule;
	uint split_triangles;
	uint part_triangles;
	uint part_vertices;  // micro-vertices and micro-triangles of parts
	uint part_micro_triangles;
	uint full_clusters;  // clusters first found full at this candidate (see rate_search.comp), and what they hold
	uint full_vertices;
	uint full_micro_triangles;
	uint abandoned;  // 1: some list cannot hold what this candidate wants
};
SHARED_LAYOUT(RateStep, 48, abandoned, 44)

// Most entries of micro_vertices and expanded_triangles, which grow on demand (mostEntries of src/frame/lists.h).
#define MOST_PACKED_ENTRIES 0x0fffffffu

struct RateSearchArgs
{
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(ClusterRecord) clusters;
	GPU_PTR(DisplacedBounds) cluster_bounds;  // 0 without frustum culling
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(ClusterRef) visible_clusters;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(DomainTriangle) split_triangles;  // 0 when no split can occur
	GPU_PTR(DomainTriangle) part_triangles;
	TableView table;
	GPU_PTR(RateStep) steps;         // finest first; step 0 is the rate that the stages before used
	GPU_PTR(View) view;              // the uniform buffer that later stages read
	GPU_PTR(uint) shared_instances;  // with structures that instances share
	uint step_count;
	uint modes;  // packSearch
};
SHARED_LAYOUT(RateSearchArgs, 128, modes, 124)

//   lists           0: count the candidates and choose one; 1: list again at the chosen one
//   deciding_lists  bit per list: its capacity is fixed, so that it limits the rate
//   split_levels    levels that triangle_split took apart
SHARED_FN uint packSearch(uint lists, uint deciding_lists, uint split_levels)
{
	return lists | (split_levels << 8) | (deciding_lists << 16);
}
SHARED_FN bool searchLists(uint modes)
{
	return (modes & 1u) != 0u;
}
SHARED_FN uint searchLevels(uint modes)
{
	return (modes >> 8) & 0xffu;
}
SHARED_FN uint searchDecidingLists(uint modes)
{
	return modes >> 16;
}

SHARED_END

#endif
