// batch_parts: pack part triangles into batches, each for one workgroup of the rasterising stages. Runs a second time, as
// retest_parts, for what the first time was left out as hidden.
//
//   in   part_triangles   DomainTriangle[]   from cluster_classify and triangle_split
//   out  batches          Batch[]            first part and count; as many as the stage that draws can hold
//   out  part_places      PartPlace[]        the order of batches; per window what is seen, then what is hidden
//   out  window_vertices  uint[]             per window: its first micro-vertex, where rays' structures are built from clusters
//   with occlusion culling:
//   in   frame_history                       depth pyramids of the frame before and of this one
//   out  window_seen      uint[]             per window: how many of it are seen
//   out  full_clusters    phase              second time: those that were hidden and are not
//
// One workgroup takes a window of BATCH_WINDOW parts at a time: prefix sums of their vertices and triangles give, for every
// part, where a batch that starts there would end; pointer jumping marks the starts that are reached from the first.
// Batches cannot overflow while their input fits (src/frame/lists.cpp). What is hidden is decided here and not where parts
// are made, so that the rate does not depend on it (C2).
// Host: src/pipeline/tessellation/batch_parts.cpp, retest_parts.cpp   Test: tests/gpu/tessellation_test.cpp, occlusion_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "tessellation/batch_parts.h"
#include "lib/lists.glsl"
#include "lib/occlusion.glsl"

layout(local_size_x = BATCH_WINDOW) in;
layout(push_constant, scalar) uniform Args { BatchPartsArgs args; };

const uint SCAN_RUN = 8u;  // lanes whose sum is known before each lane adds up those before it

shared uint sizes[BATCH_WINDOW];
shared uint run_sums[BATCH_WINDOW / SCAN_RUN];
// Sums over all lanes before lane i; of sizes of parts, vertices in the low, triangles in the high half (128 x 128 fits 16 bits).
shared uint sums[BATCH_WINDOW + 1u];
shared uint jumps[BATCH_WINDOW + 1u];
shared uint marks[BATCH_WINDOW + 1u];
shared uint order[BATCH_WINDOW];  // the window's parts, those to be batched first, and their sizes
shared uint order_sizes[BATCH_WINDOW];
shared uint batch_count;
shared uint first_batch;
shared uint first_vertex;

// Micro-vertices of a part in the low, micro-triangles in the high half.
uint partSize(uint part)
{
	DomainPiece piece = unpackTriangle(args.part_triangles.at[part]);
	PatternRange pattern = args.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
	return patternVertices(pattern) | (patternTriangles(pattern) << 16);
}

// Fills sums with what the lanes give. Few barriers matter more than few additions. Ends with a barrier.
void scan(uint size)
{
	uint lane = gl_LocalInvocationIndex;
	uint run = lane / SCAN_RUN;
	sizes[lane] = size;
	barrier();
	if (lane < BATCH_WINDOW / SCAN_RUN)
	{
		uint sum = 0u;
		for (uint i = 0u; i < SCAN_RUN; ++i)
			sum += sizes[lane * SCAN_RUN + i];
		run_sums[lane] = sum;
	}
	barrier();
	uint before = 0u;
	for (uint i = 0u; i < BATCH_WINDOW / SCAN_RUN; ++i)
		before += i < run ? run_sums[i] : 0u;
	for (uint i = 0u; i < SCAN_RUN; ++i)
		before += run * SCAN_RUN + i < lane ? sizes[run * SCAN_RUN + i] : 0u;
	sums[lane] = before;
	if (lane == BATCH_WINDOW - 1u)
		sums[BATCH_WINDOW] = before + size;
	barrier();
}

bool fits(uint from, uint to)
{
	uint size = sums[to] - sums[from];
	return to - from <= args.most_parts && (size & 0xffffu) <= args.most_vertices && (size >> 16) <= args.most_triangles;
}

// End of a batch that starts at `from`: the sums grow, so a binary search finds it. A single part always fits.
uint batchEnd(uint from, uint count)
{
	uint low = from + 1u;
	uint high = min(count, from + args.most_parts);
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
	// Until the first start jumps past the last.
	for (uint reach = 1u; reach < BATCH_WINDOW && jumps[0] != BATCH_WINDOW; reach *= 2u)
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

// Tighter than the cluster's: what displacement can do within the base triangle, on the mips that a piece with undisplaced
// corners p, q, r can read.
void narrowReach(inout DisplacedBounds bounds, TriangleReach reach, vec3 p, vec3 q, vec3 r, Placement placement)
{
	View view = frame_view;
	float farthest = max(rateDistanceSquared(placed(placement, p), view),
	                     max(rateDistanceSquared(placed(placement, q), view), rateDistanceSquared(placed(placement, r), view)));
	float footprint = farthest * view.sample_over_focal_squared * placement.inverse_scale_squared * reach.density * reach.density * 1.001;
	float level = ceil(heightLevel(footprint, MAX_HEIGHT_LEVELS));
	if (level > float(REACH_COARSE_MIP))
		return;
	vec2 interval = level <= float(REACH_FINE_MIP) ? reach.fine : reach.coarse;
	bounds.reach_low = max(bounds.reach_low, interval.x);
	bounds.reach_high = min(bounds.reach_high, interval.y);
}

bool partIsHidden(uint part)
{
	bool second = args.second_phase != 0u;
	if (!second && frame_history.has_last == 0u)
		return false;
	DomainPiece piece = unpackTriangle(args.part_triangles.at[part]);
	ClusterRef ref = args.visible_clusters.at[piece.visible_cluster];
	ClusterRecord cluster = args.clusters.at[ref.cluster];
	uint triangle = frame_surface.triangles.at[cluster.first_triangle + piece.triangle];
	vec3 p0 = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, 0u)];
	vec3 p1 = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, 1u)];
	vec3 p2 = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, 2u)];
	vec3 a = weightedVec3(p0, p1, p2, domainWeights(piece.c0));
	vec3 b = weightedVec3(p0, p1, p2, domainWeights(piece.c1));
	vec3 c = weightedVec3(p0, p1, p2, domainWeights(piece.c2));
	DisplacedBounds bounds = args.cluster_bounds.at[ref.cluster];
	InstanceRecord instance = args.instances.at[ref.instance];
	if (HAS_DISPLACEMENT)
		narrowReach(bounds, args.triangle_reaches.at[cluster.first_triangle + piece.triangle], a, b, c, placementOf(instance, frame_view));
	if (second)
		return pieceIsHidden(a, b, c, bounds, instance, frame_view, frame_history.pyramid);
	return pieceIsHidden(a, b, c, bounds, instance, frame_history.last_view, frame_history.last_pyramid);
}

// Puts what is seen of places [begin, begin + count) first; returns how many that are. The first time, places are parts, and all their
// triangles are counted.
uint sortBySeen(uint begin, uint count)
{
	uint lane = gl_LocalInvocationIndex;
	uint part = begin + lane;
	bool second = args.second_phase != 0u;
	if (second && lane < count)
		part = args.part_places.at[begin + lane].part;
	uint size = lane < count ? partSize(part) : 0u;
	bool seen = lane < count && !partIsHidden(part);
	// Those seen in the low, triangles in the high half.
	scan((seen ? 1u : 0u) | (size & 0xffff0000u));
	uint seen_count = sums[BATCH_WINDOW] & 0xffffu;
	uint seen_before = sums[lane] & 0xffffu;
	uint place = seen ? seen_before : seen_count + lane - seen_before;
	if (lane < count)
	{
		order[place] = part;
		order_sizes[place] = size;
		args.part_places.at[begin + place].part = part;
	}
	if (lane == 0u && !second)
		addMicroTriangles(args.counts, sums[BATCH_WINDOW] >> 16);
	barrier();
	return seen_count;
}

// Batches `count` parts, begin and further in the order.
void batchWindow(uint begin, uint count)
{
	uint lane = gl_LocalInvocationIndex;
	uint size = 0u;
	if (lane < count)
		size = HAS_OCCLUSION ? order_sizes[lane] : partSize(begin + lane);
	scan(size);
	if (!HAS_OCCLUSION && lane == 0u)
		addMicroTriangles(args.counts, sums[BATCH_WINDOW] >> 16);
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
		if (KEEPS_VERTICES)
			first_vertex = reserveEntries(args.heads, LIST_MICRO_VERTICES, sums[BATCH_WINDOW] & 0xffffu);
		if (EXPANDS_TRIANGLES)
			reserveEntries(args.heads, LIST_EXPANDED_TRIANGLES, sums[BATCH_WINDOW] >> 16);
	}
	if (BUILDS_CLUSTERS && lane == 0u)
		args.window_vertices.at[begin / BATCH_WINDOW] = first_vertex;
	barrier();
	if (starts && first_batch + place < args.heads.at[LIST_BATCHES].capacity)
		args.batches.at[first_batch + place] = Batch(packBatch(begin + lane, end - lane), sums[end] - sums[lane], first_vertex + (sums[lane] & 0xffffu));
	if (lane < count)
		args.part_places.at[begin + lane] = PartPlace(HAS_OCCLUSION ? order[lane] : begin + lane, sums[lane]);
	barrier();
}

// What is seen of a window; the second time, of what the first time was hidden.
void takeWindow(uint window, uint part_count)
{
	uint lane = gl_LocalInvocationIndex;
	uint begin = window * BATCH_WINDOW;
	uint count = min(BATCH_WINDOW, part_count - begin);
	if (args.second_phase != 0u)
	{
		uint seen_before = args.window_seen.at[window];
		begin += seen_before;
		count -= seen_before;
	}
	if (!HAS_OCCLUSION)
	{
		batchWindow(begin, count);
		return;
	}
	if (count == 0u)
		return;
	uint seen = sortBySeen(begin, count);
	if (lane == 0u && args.second_phase == 0u)
	{
		args.window_seen.at[window] = seen;
		atomicAdd(args.counts.at[0].hidden_parts, count - seen);
	}
	if (lane == 0u && args.second_phase != 0u && seen > 0u)
		atomicAdd(args.counts.at[0].revealed_parts, seen);
	if (seen > 0u)
		batchWindow(begin, seen);
}

void retestClusters()
{
	uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
	uint count = entriesOf(args.heads, LIST_FULL_CLUSTERS);
	for (uint i = gl_GlobalInvocationID.x; i < count; i += stride)
	{
		FullCluster full = args.full_clusters.at[i];
		if (full.phase != PHASE_HIDDEN)
			continue;
		ClusterRef ref = args.visible_clusters.at[full.visible_cluster];
		DisplacedBounds bounds = args.cluster_bounds.at[ref.cluster];
		if (!clusterIsHidden(bounds, args.instances.at[ref.instance], frame_view, frame_history.pyramid))
		{
			args.full_clusters.at[i].phase = PHASE_SECOND;
			atomicAdd(args.counts.at[0].revealed_clusters, 1u);
		}
	}
}

void main()
{
	bool second = HAS_OCCLUSION && args.second_phase != 0u;
	if (second && args.counts.at[0].overflow != 0u)
		return;
	uint part_count = uint64_t(args.part_triangles) != 0ul ? entriesOf(args.heads, LIST_PART_TRIANGLES) : 0u;
	for (uint window = gl_WorkGroupID.x; window * BATCH_WINDOW < part_count; window += gl_NumWorkGroups.x)
		takeWindow(window, part_count);
	if (second)
		retestClusters();
}
