// batch_parts: pack consecutive part triangles into batches, each for one workgroup of the rasterising stages.
//
//   in   part_triangles   DomainTriangle[]   from cluster_classify and triangle_split
//   out  batches          Batch[]            first part and count; at most 32 parts, and what the stage that draws can hold
//   out  part_offsets     uint[]             micro-vertices and micro-triangles before each part
//
// One workgroup takes BATCH_WINDOW parts at a time: prefix sums of their vertices and triangles give, for every part,
// where a batch that starts there would end; pointer jumping marks the starts that are reached from the first.
// At most one batch per part, so batches cannot overflow while its input fits.
// Host: src/pipeline/tessellation/batch_parts.cpp   Test: tests/gpu/tessellation_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "tessellation/batch_parts.h"
#include "lib/lists.glsl"

layout(local_size_x = BATCH_WINDOW) in;
layout(push_constant, scalar) uniform Args { BatchPartsArgs args; };

// Sums of all parts before index i: vertices in the low, triangles in the high half (128 x 128 fits 16 bits).
shared uint sums[BATCH_WINDOW + 1u];
shared uint jumps[BATCH_WINDOW + 1u];
shared uint marks[BATCH_WINDOW + 1u];
shared uint batch_count;
shared uint first_batch;
shared uint first_vertex;

uint partSize(uint part, uint count)
{
	if (gl_LocalInvocationIndex >= count)
		return 0u;
	DomainPiece piece = unpackTriangle(args.part_triangles.at[part]);
	PatternRange pattern = args.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
	return patternVertices(pattern) | (patternTriangles(pattern) << 16);
}

// Inclusive scan of `size` over the workgroup into sums[1..].
void scan(uint size)
{
	uint lane = gl_LocalInvocationIndex;
	sums[lane + 1u] = size;
	if (lane == 0u)
		sums[0] = 0u;
	barrier();
	for (uint step = 1u; step < BATCH_WINDOW; step *= 2u)
	{
		uint before = lane >= step ? sums[lane + 1u - step] : 0u;
		barrier();
		sums[lane + 1u] += before;
		barrier();
	}
}

bool fits(uint from, uint to)
{
	uint size = sums[to] - sums[from];
	return to - from <= BATCH_MAX_PARTS && (size & 0xffffu) <= args.most_vertices && (size >> 16) <= args.most_triangles;
}

// End of a batch that starts at `from`: the sums grow, so a binary search finds it. A single part always fits.
uint batchEnd(uint from, uint count)
{
	uint low = from + 1u;
	uint high = min(count, from + BATCH_MAX_PARTS);
	while (low < high)
	{
		uint middle = (low + high + 1u) / 2u;
		if (fits(from, middle))
			low = middle;
		else
			high = middle - 1u;
	}
	return low;
}

// Marks every batch start that is reached from part 0 by jumping from start to end.
void markStarts()
{
	uint lane = gl_LocalInvocationIndex;
	for (uint reach = 1u; reach < BATCH_WINDOW; reach *= 2u)
	{
		uint jump = jumps[lane];
		bool marked = marks[lane] != 0u;
		uint farther = jumps[jump];
		barrier();
		if (marked)
			marks[jump] = 1u;
		jumps[lane] = farther;
		barrier();
	}
}

void main()
{
	uint lane = gl_LocalInvocationIndex;
	uint part_count = entriesOf(args.heads, LIST_PART_TRIANGLES);
	for (uint first = gl_WorkGroupID.x * BATCH_WINDOW; first < part_count; first += gl_NumWorkGroups.x * BATCH_WINDOW)
	{
		uint count = min(BATCH_WINDOW, part_count - first);
		uint size = partSize(first + lane, count);
		scan(size);

		uint end = lane < count ? batchEnd(lane, count) : BATCH_WINDOW;
		jumps[lane] = lane < count && end < count ? end : BATCH_WINDOW;
		marks[lane] = lane == 0u ? 1u : 0u;
		if (lane == 0u)
		{
			jumps[BATCH_WINDOW] = BATCH_WINDOW;
			marks[BATCH_WINDOW] = 0u;
			batch_count = 0u;
		}
		barrier();
		markStarts();

		bool starts = lane < count && marks[lane] != 0u;
		uint place = starts ? atomicAdd(batch_count, 1u) : 0u;
		barrier();
		if (lane == 0u)
		{
			first_batch = reserveEntries(args.heads, LIST_BATCHES, batch_count);
			addMicroTriangles(args.counts, sums[BATCH_WINDOW] >> 16);
			if (KEEPS_VERTICES)
				first_vertex = reserveEntries(args.heads, LIST_MICRO_VERTICES, sums[BATCH_WINDOW] & 0xffffu);
			if (EXPANDS_TRIANGLES)
				reserveEntries(args.heads, LIST_EXPANDED_TRIANGLES, sums[BATCH_WINDOW] >> 16);
		}
		barrier();
		if (starts && first_batch + place < args.heads.at[LIST_BATCHES].capacity)
			args.batches.at[first_batch + place] = Batch(packBatch(first + lane, end - lane), sums[end] - sums[lane], first_vertex + (sums[lane] & 0xffffu));
		if (lane < count)
			args.part_offsets.at[first + lane] = sums[lane];
		barrier();
	}
}
