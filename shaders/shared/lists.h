// lists.h: append lists between stages and how a frame counts them (DESIGN.md, contracts C2 and C7).
#ifndef TESSERA_SHARED_LISTS_H
#define TESSERA_SHARED_LISTS_H
#include "shared/lang.h"

SHARED_BEGIN

// Head of an append list: several workgroups append, later stages read. `group_*` is a ready argument of an indirect
// draw with one workgroup per entry, laid out as rows of group_width (device limits forbid one long row).
struct ListHead
{
	uint group_width;  // constant, set by the host
	uint group_rows;   // rows begun: grows with the entries
	uint group_depth;  // 1
	uint wanted;       // entries the producers asked for; more than capacity: the frame is coarsened (C2)
	uint capacity;     // entries the buffer holds
	uint peak;         // largest `wanted` since the list was made
	uint peak_used;    // most entries that a drawn frame held
	uint unused[57];   // heads lie 256 B apart, so that appends to different lists do not share a cache line
};
SHARED_LAYOUT(ListHead, 256, unused, 28)

// The lists, in the order of their heads. Their names, a promise of the stats, are in src/frame/lists.cpp.
#define LIST_CLUSTER_GROUPS 0u
#define LIST_VISIBLE_CLUSTERS 1u
#define LIST_FULL_CLUSTERS 2u
#define LIST_SPLIT_TRIANGLES 3u
#define LIST_PART_TRIANGLES 4u
#define LIST_BATCHES 5u
#define LIST_MICRO_VERTICES 6u
#define LIST_EXPANDED_TRIANGLES 7u
#define LIST_COUNT 8u

#define MAX_SPLIT_LEVELS 32

// What a frame counts beside its lists.
struct FrameCounts
{
	uint overflow;  // 1: some list wanted more than its capacity; nothing is drawn from this attempt
	uint covered_pixels;
	uint micro_low;  // micro-triangles of part triangles, 64 bits in two words
	uint micro_high;
	uint full_cluster_triangles;
	uint expanded_triangles;  // taken so far by evaluate_vertices
	uint rate_step;           // candidate that rate_search chose: 0 = the rate that the frame was planned for
	uint listed_again;        // 1: rate_search emptied the lists and filled them at that rate
	uint levels_missing;      // split triangles left over by too few levels; listed again since
	uint search_finished;     // workgroups of rate_search that have counted
	uint second_batches;      // first batch of the second phase
	uint hidden_parts;        // not rasterised in the first phase
	uint revealed_parts;      // but in the second
	uint hidden_clusters;     // so for full clusters
	uint revealed_clusters;
	uint dump_vertices;  // that dump_micro wants to write
	uint dump_triangles;
	uint left_items;        // that raster_small left to raster_micro
	uint hidden_instances;  // whose segments have grown in this frame because something hides them
	uint shown_instances;   // of them those that may be seen all the same: the frame is drawn again
	uint shared_instances;  // whose rays go through structures that instances share, and all clusters of their meshes
	uint shared_clusters;
	uint split_count[MAX_SPLIT_LEVELS];  // split triangles appended per level; level 0 by cluster_classify
};
SHARED_LAYOUT(FrameCounts, 216, split_count, 88)

// An entry of cluster_groups: up to CLUSTER_GROUP_SIZE clusters of one instance.
#define CLUSTER_GROUP_SIZE 64u
struct ClusterGroup
{
	uint instance;
	uint first_cluster;  // global index
	uint cluster_count;
};
SHARED_LAYOUT(ClusterGroup, 12, cluster_count, 8)

// A cluster that is drawn as stored.
struct FullCluster
{
	uint visible_cluster;  // index into visible_clusters
	uint first_vertex;     // its range of micro_vertices, where vertices are kept there
	uint phase;            // PHASE_*: when it is rasterised
};
SHARED_LAYOUT(FullCluster, 12, phase, 8)

// Occlusion culling rasterises what the frame before does not hide, then what this frame's depth so far does not hide either.
#define PHASE_FIRST 0u
#define PHASE_SECOND 1u
#define PHASE_HIDDEN 2u  // hidden by the frame before: neither, unless it is found to be seen
// Beside rays, with which nothing is looked for that is hidden: rays meet it in a structure that instances share, so none of it is expanded.
#define PHASE_SHARED 3u

// A batch: consecutive places of part_places that one workgroup draws.
struct Batch
{
	uint parts;         // packBatch
	uint counts;        // micro-vertices | micro-triangles << 16
	uint first_vertex;  // its range of micro_vertices, where vertices are kept there
};
SHARED_LAYOUT(Batch, 12, first_vertex, 8)
// An entry of part_places: which part comes at this place in the order of batches, and what comes before it.
struct PartPlace
{
	uint part;     // index into part_triangles
	uint offsets;  // micro-vertices | micro-triangles << 16 of the parts that are packed with it and come before
};
SHARED_LAYOUT(PartPlace, 8, offsets, 4)
#define BATCH_MAX_PARTS 32u
#define BATCH_WINDOW 128u  // parts that are packed together
// What a mesh shader can emit at once, and what one pattern can have.
#define BATCH_MAX_VERTICES 96u
#define BATCH_MAX_TRIANGLES 128u
// Where compute rasterises: several patterns, so that what a workgroup loads for them is loaded side by side. Few enough parts that what
// they need stays small: shared memory decides how many workgroups are resident.
#define RASTER_BATCH_PARTS 16u
#define RASTER_BATCH_VERTICES 512u
#define RASTER_BATCH_TRIANGLES 768u
SHARED_FN uint batchVertices(Batch batch)
{
	return batch.counts & 0xffffu;
}
SHARED_FN uint batchTriangles(Batch batch)
{
	return batch.counts >> 16;
}
SHARED_FN uint packBatch(uint first_part, uint part_count)
{
	return first_part | ((part_count - 1u) << 24);
}
SHARED_FN uint batchFirst(uint batch)
{
	return batch & 0xffffffu;
}
SHARED_FN uint batchCount(uint batch)
{
	return ((batch >> 24) & 31u) + 1u;
}

SHARED_END

#endif
