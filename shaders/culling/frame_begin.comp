// frame_begin: empty every list and count before a frame (or a further attempt or round of it).
//
//   out  heads    ListHead[LIST_COUNT]   wanted and rows 0; capacity and peaks stay
//   out  counts   FrameCounts            all 0
//
// One workgroup. Host: src/pipeline/culling/frame_begin.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "culling/frame_begin.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Args { FrameBeginArgs args; };

void main()
{
	uint lane = gl_LocalInvocationIndex;
	if (lane < LIST_COUNT)
	{
		args.heads.at[lane].wanted = 0u;
		args.heads.at[lane].group_rows = 0u;
	}
	if (lane < MAX_SPLIT_LEVELS)
		args.counts.at[0].split_count[lane] = 0u;
	if (lane == 0u)
	{
		args.counts.at[0].overflow = 0u;
		args.counts.at[0].covered_pixels = 0u;
		args.counts.at[0].micro_low = 0u;
		args.counts.at[0].micro_high = 0u;
		args.counts.at[0].full_cluster_triangles = 0u;
		args.counts.at[0].expanded_triangles = 0u;
		args.counts.at[0].second_batches = 0u;
		args.counts.at[0].hidden_parts = 0u;
		args.counts.at[0].revealed_parts = 0u;
		args.counts.at[0].hidden_clusters = 0u;
		args.counts.at[0].revealed_clusters = 0u;
		args.counts.at[0].dump_vertices = 0u;
		args.counts.at[0].dump_triangles = 0u;
		args.counts.at[0].left_items = 0u;
		args.counts.at[0].hidden_instances = 0u;
		args.counts.at[0].shown_instances = 0u;
		args.counts.at[0].shared_instances = 0u;
		args.counts.at[0].shared_clusters = 0u;
		args.counts.at[0].rate_step = 0u;
		args.counts.at[0].listed_again = 0u;
		args.counts.at[0].levels_missing = 0u;
		args.counts.at[0].search_finished = 0u;
	}
}
