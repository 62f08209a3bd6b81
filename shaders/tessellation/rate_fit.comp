// rate_fit: see whether every list fits after all; if not, nothing is drawn.
//
//   in   heads, counts    what the stages before it wanted
//   out  heads            peaks; the rows of all draws become 0 when something did not fit
//   out  counts           overflow
//   out  indexed_draw     arguments of the indexed draw, where micro-triangles are expanded
//
// One workgroup. What rate_search cannot make fit is drawn again in rounds, or with larger packings (DESIGN.md, C2): no
// triangle is ever dropped. Host: src/pipeline/tessellation/rate_fit.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tessellation/rate_fit.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Args { RateFitArgs args; };

void main()
{
	bool overflow = args.counts.at[0].split_count[args.split_levels] != 0u;
	for (uint list = 0u; list < LIST_COUNT; ++list)
	{
		uint wanted = args.heads.at[list].wanted;
		args.heads.at[list].peak = max(args.heads.at[list].peak, wanted);
		overflow = overflow || wanted > args.heads.at[list].capacity;
	}
	args.counts.at[0].overflow = overflow ? 1u : 0u;
	args.counts.at[0].second_batches = args.heads.at[LIST_BATCHES].wanted;
	for (uint list = 0u; list < LIST_COUNT; ++list)
	{
		if (overflow)
			args.heads.at[list].group_rows = 0u;
		else
			args.heads.at[list].peak_used = max(args.heads.at[list].peak_used, args.heads.at[list].wanted);
	}
	if (uint64_t(args.indexed_draw) != 0ul)
	{
		args.indexed_draw.at[0].index_count = overflow ? 0u : 3u * args.heads.at[LIST_EXPANDED_TRIANGLES].wanted;
		args.indexed_draw.at[0].instance_count = 1u;
		args.indexed_draw.at[0].first_index = 0u;
		args.indexed_draw.at[0].vertex_offset = 0;
		args.indexed_draw.at[0].first_instance = 0u;
	}
}
