// rate_search: when a list would overflow, find the smallest coarsening that fits and list everything again at it (C2).
//
//   in   visible_clusters                                what is tessellated
//   in   heads, counts                                   what the stages before wanted at the planned rate
//   in   steps             RateStep[]                    candidates: rates x 2^(j/16), from the host
//   out  full_clusters, part_triangles, split_triangles  as cluster_classify and triangle_split would make them at the granted rate
//   out  view              View                          the granted rate
//   out  counts            which candidate
//
// Two dispatches, both of which end at once when everything fits. The first counts all candidates without writing lists; its last
// workgroup chooses. The second lists at the chosen rate; same code, so same counts. No host is asked, nothing is drawn before.
//
// One workgroup takes a cluster at one candidate after another and walks down the splits of its triangles (lib/split_walk.glsl).
// Where clusters are few, candidates are dealt to several workgroups (block), and the children of a first cut too (slice).
// A candidate is abandoned as soon as its counts exceed a list, so it costs no more than filling that list.
// Host: src/pipeline/tessellation/rate_search.cpp   Test: tests/gpu/rate_search_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "tessellation/rate_search.h"
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Args { RateSearchArgs args; };

#include "lib/split_walk.glsl"

const uint UNITS_PER_WORKGROUP = 4u;  // wanted, where clusters are few
const uint MOST_SLICES = 64u;
const uint FLUSHED_PARTS = 512u;  // parts between two looks at what the other workgroups counted

uint step_index;  // the candidate that the workgroup is at

// Counted and not yet added to the candidate's.
shared uint part_sum;
shared uint split_sum;
shared uint vertex_sum;
shared uint micro_sum;
shared uint is_last;
shared uint chosen;

uint listLimit(uint list)
{
	return (searchDecidingLists(args.modes) >> list & 1u) != 0u ? args.heads.at[list].capacity : MOST_PACKED_ENTRIES;
}

void clearSums()
{
	split_sum = 0u;
	part_sum = 0u;
	vertex_sum = 0u;
	micro_sum = 0u;
}

// Adds what was counted to the candidate's counts; abandons it when they exceed a list. One lane.
void flushSums()
{
	uint splits = atomicAdd(args.steps.at[step_index].split_triangles, split_sum) + split_sum;
	uint parts = atomicAdd(args.steps.at[step_index].part_triangles, part_sum) + part_sum;
	uint vertices = 0u, micro = 0u;
	if (KEEPS_VERTICES)
	{
		vertices = atomicAdd(args.steps.at[step_index].part_vertices, vertex_sum) + vertex_sum;
		micro = atomicAdd(args.steps.at[step_index].part_micro_triangles, micro_sum) + micro_sum;
	}
	if (stop != 0u || splits > listLimit(LIST_SPLIT_TRIANGLES) || parts > listLimit(LIST_PART_TRIANGLES) ||
	    vertices > listLimit(LIST_MICRO_VERTICES) || micro > listLimit(LIST_EXPANDED_TRIANGLES))
		atomicOr(args.steps.at[step_index].abandoned, 1u);
	stop = atomicOr(args.steps.at[step_index].abandoned, 0u);
	clearSums();
}

void takePlaces()
{
	if (searchLists(args.modes))
	{
		if (part_count > 0u)
			first_part = reserveEntries(args.heads, LIST_PART_TRIANGLES, part_count);
		if (split_count > 0u)
			first_split = reserveEntries(args.heads, LIST_SPLIT_TRIANGLES, split_count);
		return;
	}
	part_sum += part_count;
	split_sum += split_count;
	vertex_sum += vertex_count;
	micro_sum += micro_count;
	if (part_sum + split_sum >= FLUSHED_PARTS)
		flushSums();
}

void loadStep(uint step)
{
	step_index = step;
	view.rate_over_focal_squared = args.steps.at[step].rate_over_focal_squared;
	rule = args.steps.at[step].rule;
	barrier();
	if (gl_LocalInvocationIndex == 0u)
	{
		stop = searchLists(args.modes) ? 0u : atomicOr(args.steps.at[step].abandoned, 0u);
		clearSums();
	}
	barrier();
}

// --- counting --------------------------------------------------------------------------------------------------------------------

bool isOverfull(uint list) { return args.heads.at[list].wanted > listLimit(list); }

// A packing of a fixed size is filled later: unless it holds as many of the largest patterns, only counting can say whether it fits.
bool packingMayOverflow(uint list, uint most_per_part)
{
	bool decides = (searchDecidingLists(args.modes) >> list & 1u) != 0u;
	uint most = args.heads.at[list].wanted + args.heads.at[LIST_PART_TRIANGLES].wanted * most_per_part;
	return decides && most > args.heads.at[list].capacity;
}

// The finest candidate worth counting; NO_INDEX: everything fits, or no rate can help.
uint firstCandidate()
{
	// Lists of clusters; a cluster that is full stays so at every coarser rate.
	if (isOverfull(LIST_CLUSTER_GROUPS) || isOverfull(LIST_VISIBLE_CLUSTERS) || isOverfull(LIST_FULL_CLUSTERS))
		return NO_INDEX;
	if (isOverfull(LIST_SPLIT_TRIANGLES) || isOverfull(LIST_PART_TRIANGLES) || isOverfull(LIST_MICRO_VERTICES) || isOverfull(LIST_EXPANDED_TRIANGLES))
		return 1u;
	return packingMayOverflow(LIST_MICRO_VERTICES, BATCH_MAX_VERTICES) || packingMayOverflow(LIST_EXPANDED_TRIANGLES, BATCH_MAX_TRIANGLES) || args.counts.at[0].split_count[searchLevels(args.modes)] != 0u ? 0u : NO_INDEX;
}

// How the work is dealt out: unit = (block * clusters + cluster) * slices + slice.
struct Dealing
{
	uint clusters;
	uint blocks;  // block b takes candidates b, b + blocks ...
	uint slices;
};

Dealing dealingOf(uint candidates)
{
	Dealing dealing;
	dealing.clusters = entriesOf(args.heads, LIST_VISIBLE_CLUSTERS);
	uint wanted = gl_NumWorkGroups.x * UNITS_PER_WORKGROUP / max(dealing.clusters, 1u);
	dealing.blocks = clamp(wanted, 1u, candidates);
	dealing.slices = clamp(wanted / dealing.blocks, 1u, MOST_SLICES);
	return dealing;
}

// A cluster that is full at the present candidate.
void takeFull()
{
	if (gl_LocalInvocationIndex != 0u || slice != 0u)
		return;
	bool is_shared = SHARES_STRUCTURES && args.shared_instances.at[args.visible_clusters.at[visible_index].instance] != NOT_SHARED;
	if (searchLists(args.modes))
	{
		uint slot = reserveEntries(args.heads, LIST_FULL_CLUSTERS, 1u);
		listFullCluster(args.heads, args.counts, args.full_clusters, slot, visible_index, cluster, is_shared ? PHASE_SHARED : PHASE_FIRST);
		return;
	}
	atomicAdd(args.steps.at[step_index].full_clusters, 1u);
	if (!(is_shared && READS_BUFFER))
		atomicAdd(args.steps.at[step_index].full_vertices, clusterVertices(cluster));
	if (!is_shared)
		atomicAdd(args.steps.at[step_index].full_micro_triangles, clusterTriangles(cluster));
}

// One unit: a cluster at the candidates of a block. Once full, it is full at every coarser one: chooseStep knows.
void takeUnit(uint unit, uint first, uint end, Dealing dealing)
{
	slice = unit % dealing.slices;
	slices = dealing.slices;
	loadCluster(unit / dealing.slices % dealing.clusters);
	uint block = unit / dealing.slices / dealing.clusters;
	for (uint step = first + block; step < end; step += dealing.blocks)
	{
		loadStep(step);
		if (stop != 0u)
			continue;
		if (!walkCluster(searchLists(args.modes)))
		{
			takeFull();
			return;
		}
		barrier();
		if (gl_LocalInvocationIndex == 0u && !searchLists(args.modes))
			flushSums();
	}
}

// --- choosing --------------------------------------------------------------------------------------------------------------------

// Reads past caches: other workgroups of this dispatch counted.
bool stepFits(uint step, uint first, uint blocks)
{
	if (atomicOr(args.steps.at[step].abandoned, 0u) != 0u)
		return false;
	uint full = 0u;
	uint vertices = atomicAdd(args.steps.at[step].part_vertices, 0u);
	uint micro = atomicAdd(args.steps.at[step].part_micro_triangles, 0u);
	for (uint finer = first + (step - first) % blocks; finer <= step; finer += blocks)
	{
		full += atomicAdd(args.steps.at[finer].full_clusters, 0u);
		vertices += atomicAdd(args.steps.at[finer].full_vertices, 0u);
		micro += atomicAdd(args.steps.at[finer].full_micro_triangles, 0u);
	}
	return full <= listLimit(LIST_FULL_CLUSTERS) && (!KEEPS_VERTICES || vertices <= listLimit(LIST_MICRO_VERTICES)) &&
	       (!EXPANDS_TRIANGLES || micro <= listLimit(LIST_EXPANDED_TRIANGLES));
}

void clearCounts(uint step)
{
	args.steps.at[step].split_triangles = 0u;
	args.steps.at[step].part_triangles = 0u;
	args.steps.at[step].part_vertices = 0u;
	args.steps.at[step].part_micro_triangles = 0u;
	args.steps.at[step].full_clusters = 0u;
	args.steps.at[step].full_vertices = 0u;
	args.steps.at[step].full_micro_triangles = 0u;
	args.steps.at[step].abandoned = 0u;
}

// Empties what the stages before have listed; the peaks keep what it wanted.
void emptyList(uint list)
{
	args.heads.at[list].peak = max(args.heads.at[list].peak, args.heads.at[list].wanted);
	args.heads.at[list].wanted = 0u;
	args.heads.at[list].group_rows = 0u;
}

// The rate of everything that follows. One lane.
void grant(uint step)
{
	args.view.at[0].rate_over_focal_squared = args.steps.at[step].rate_over_focal_squared;
	args.view.at[0].sample_over_focal_squared = args.steps.at[step].sample_over_focal_squared;
	args.counts.at[0].rate_step = step;
	args.counts.at[0].listed_again = 1u;
	args.counts.at[0].levels_missing = args.counts.at[0].split_count[searchLevels(args.modes)];
	args.counts.at[0].full_cluster_triangles = 0u;
	args.counts.at[0].hidden_clusters = 0u;
	for (uint level = 0u; level < MAX_SPLIT_LEVELS; ++level)
		args.counts.at[0].split_count[level] = 0u;
	for (uint list = LIST_FULL_CLUSTERS; list < LIST_COUNT; ++list)
		emptyList(list);
}

// The finest candidate that fits. None: the lists stay as they are, overfull. The last workgroup to finish counting.
void chooseStep(uint first, uint blocks)
{
	if (gl_LocalInvocationIndex == 0u)
		chosen = NO_INDEX;
	barrier();
	for (uint step = first + gl_LocalInvocationIndex; step < args.step_count; step += gl_WorkGroupSize.x)
		if (stepFits(step, first, blocks))
			atomicMin(chosen, step);
	barrier();
	for (uint step = gl_LocalInvocationIndex; step < args.step_count; step += gl_WorkGroupSize.x)
		clearCounts(step);
	if (gl_LocalInvocationIndex != 0u || chosen == NO_INDEX)
		return;
	// Step 0 is listed already, unless levels were missing.
	if (chosen > 0u || args.counts.at[0].split_count[searchLevels(args.modes)] != 0u)
		grant(chosen);
}

// True in the workgroup that ends last, which then sees what all others counted.
bool endsLast()
{
	memoryBarrierBuffer();
	barrier();
	if (gl_LocalInvocationIndex == 0u)
		is_last = atomicAdd(args.counts.at[0].search_finished, 1u) + 1u == gl_NumWorkGroups.x ? 1u : 0u;
	barrier();
	memoryBarrierBuffer();
	return is_last != 0u;
}

void main()
{
	bool lists = searchLists(args.modes);
	uint first = lists ? args.counts.at[0].rate_step : firstCandidate();
	uint end = lists ? first + 1u : args.step_count;
	if (first >= end || (lists && args.counts.at[0].listed_again == 0u))
		return;
	Dealing dealing = dealingOf(end - first);
	uint units = dealing.clusters * dealing.blocks * dealing.slices;
	for (uint unit = gl_WorkGroupID.x; unit < units; unit += gl_NumWorkGroups.x)
		takeUnit(unit, first, end, dealing);
	if (!lists && endsLast())
		chooseStep(first, dealing.blocks);
}
