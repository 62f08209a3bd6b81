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
// One workgroup takes a cluster at one candidate after another and walks down the splits of each triangle, depth first:
// per depth one split triangle and a bit for each of its children that is still to be cut. No level can be missing.
// Where clusters are few, candidates are dealt to several workgroups (block), and the children of a first cut too (slice).
// A candidate is abandoned as soon as its counts exceed a list, so it costs no more than filling that list.
// Host: src/pipeline/tessellation/rate_search.cpp   Test: tests/gpu/rate_search_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "tessellation/rate_search.h"
#include "lib/classify.glsl"
#include "lib/full_clusters.glsl"
#include "shared/surface.h"

layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Args { RateSearchArgs args; };

const uint ALL_ONE = 0x111u;
const uint UNITS_PER_WORKGROUP = 4u;  // wanted, where clusters are few
const uint MOST_SLICES = 64u;
const uint FLUSHED_PARTS = 512u;  // parts between two looks at what the other workgroups counted

// The cluster that the workgroup is at.
uint visible_index;
ClusterRecord cluster;
Placement placement;
PlacedReach reach;
View view;  // with the candidate's rate
FactorRule rule;
uint step_index;
uint slice;
uint slices;

shared vec3 cluster_relative[128];
// The triangle that is cut at the present depth; depth 0 is the cluster itself, its children the base triangles.
shared DomainTriangle cut_triangles[MAX_SPLIT_LEVELS];
shared uint pending[MAX_SPLIT_LEVELS][4];  // bit per child that is still to be cut
shared DomainPoint domains[BATCH_MAX_VERTICES];
shared vec3 relative[BATCH_MAX_VERTICES];
shared uint decisions[128];
// Of the children at hand.
shared uint part_count;
shared uint split_count;
shared uint vertex_count;
shared uint micro_count;
shared uint tessellated;
shared uint first_part;
shared uint first_split;
// Counted and not yet added to the candidate's.
shared uint part_sum;
shared uint split_sum;
shared uint vertex_sum;
shared uint micro_sum;

shared uint next_child;
shared uint stop;  // the candidate is abandoned
shared uint is_last;
shared uint chosen;

// --- the walk --------------------------------------------------------------------------------------------------------------------

struct Child
{
	ClassifiedCorner p;
	ClassifiedCorner q;
	ClassifiedCorner r;
	uint triangle;  // of the cluster
};

// What is cut at a depth above 0.
struct Cut
{
	DomainPiece piece;
	PatternRange pattern;
};

Cut cutAt(uint depth)
{
	Cut cut;
	cut.piece = unpackTriangle(cut_triangles[depth]);
	cut.pattern = args.table.patterns.at[patternIndex(cut.piece.a, cut.piece.b, cut.piece.c)];
	return cut;
}

ClassifiedCorner cutVertex(Cut cut, uint vertex)
{
	uint triangle = frame_surface.triangles.at[cluster.first_triangle + cut.piece.triangle];
	DomainPoint point = patternPoint(cut.piece, vertex, cut.pattern, args.table, triangleEdgeFlags(triangle));
	vec3 p0 = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, 0u)];
	vec3 p1 = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, 1u)];
	vec3 p2 = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, 2u)];
	return ClassifiedCorner(point, placed(placement, weightedVec3(p0, p1, p2, domainWeights(point))));
}

Child baseChild(uint t)
{
	uint triangle = frame_surface.triangles.at[cluster.first_triangle + t];
	return Child(ClassifiedCorner(domainCorner(0u), cluster_relative[triangleVertex(triangle, 0u)]),
	             ClassifiedCorner(domainCorner(1u), cluster_relative[triangleVertex(triangle, 1u)]),
	             ClassifiedCorner(domainCorner(2u), cluster_relative[triangleVertex(triangle, 2u)]), t);
}

// Child t of the cut whose vertices are in shared memory.
Child cutChild(Cut cut, uint t)
{
	uvec3 corners = patternTriangle(t, cut.pattern, args.table, cut.piece.mirror);
	return Child(ClassifiedCorner(domains[corners.x], relative[corners.x]), ClassifiedCorner(domains[corners.y], relative[corners.y]),
	             ClassifiedCorner(domains[corners.z], relative[corners.z]), cut.piece.triangle);
}

// The same when other vertices are there by now.
Child cutChildAgain(Cut cut, uint t)
{
	uvec3 corners = patternTriangle(t, cut.pattern, args.table, cut.piece.mirror);
	return Child(cutVertex(cut, corners.x), cutVertex(cut, corners.y), cutVertex(cut, corners.z), cut.piece.triangle);
}

// Slices share the base triangles' decisions; the first counts them. The children of a first cut are dealt out.
bool isMine(uint depth, uint t) { return depth == 0u ? slice == 0u : depth > 1u || t % slices == slice; }

// Decides one child and counts it; the place within the workgroup's part of the list rides in the upper bits.
void decideChild(uint depth, uint t, Child child)
{
	uint decision = decideTriangle(child.p, child.q, child.r, view, rule);
	if (decision != ALL_ONE)
		tessellated = 1u;
	uint cull_frustum = uint64_t(args.cluster_bounds) != 0ul ? 1u : 0u;
	if (isOutOfView(child.p, child.q, child.r, reach, cull_frustum, view))
		decision = DECISION_CULLED;
	uint place = 0u;
	bool splits = decision != DECISION_CULLED && (decision & DECISION_SPLIT) != 0u;
	if (splits && (depth == 0u || isMine(depth, t)))
		atomicOr(pending[depth][t / 32u], 1u << (t % 32u));
	if (!isMine(depth, t))
		decision = DECISION_CULLED;
	else if (splits)
		place = atomicAdd(split_count, 1u);
	else if (decision != DECISION_CULLED)
	{
		place = atomicAdd(part_count, 1u);
		if (KEEPS_VERTICES)
		{
			DomainPiece piece = unpackTriangle(decidedTriangle(decision, child.p.domain, child.q.domain, child.r.domain, 0u, 0u));
			PatternRange pattern = args.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
			atomicAdd(vertex_count, patternVertices(pattern));
			atomicAdd(micro_count, patternTriangles(pattern));
		}
	}
	decisions[t] = decision | (place << 16);
}

void writeChild(uint t, Child child)
{
	uint decision = decisions[t] & 0xffffu;
	uint place = decisions[t] >> 16;
	if (decision == DECISION_CULLED)
		return;
	DomainTriangle record = decidedTriangle(decision, child.p.domain, child.q.domain, child.r.domain, visible_index, child.triangle);
	if ((decision & DECISION_SPLIT) != 0u)
	{
		if (first_split + place < args.heads.at[LIST_SPLIT_TRIANGLES].capacity)
			args.split_triangles.at[first_split + place] = record;
	}
	else if (first_part + place < args.heads.at[LIST_PART_TRIANGLES].capacity)
		args.part_triangles.at[first_part + place] = record;
}

uint listLimit(uint list)
{
	return (args.deciding_lists >> list & 1u) != 0u ? args.heads.at[list].capacity : MOST_PACKED_ENTRIES;
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
	if (splits > listLimit(LIST_SPLIT_TRIANGLES) || parts > listLimit(LIST_PART_TRIANGLES) || vertices > listLimit(LIST_MICRO_VERTICES) ||
	    micro > listLimit(LIST_EXPANDED_TRIANGLES))
		atomicOr(args.steps.at[step_index].abandoned, 1u);
	stop |= atomicOr(args.steps.at[step_index].abandoned, 0u);
	split_sum = 0u;
	part_sum = 0u;
	vertex_sum = 0u;
	micro_sum = 0u;
}

// Counts the decided children, or takes their places in the lists. One lane.
void takeChildren()
{
	if (args.lists != 0u)
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

void beginChildren(uint depth)
{
	barrier();
	if (gl_LocalInvocationIndex == 0u)
	{
		part_count = 0u;
		split_count = 0u;
		vertex_count = 0u;
		micro_count = 0u;
		for (uint word = 0u; word < 4u; ++word)
			pending[depth][word] = 0u;
		if (depth == 0u)
			tessellated = 0u;
	}
	barrier();
}

// The base triangles. False when every factor of the cluster is 1.
bool takeBaseTriangles()
{
	beginChildren(0u);
	for (uint t = gl_LocalInvocationIndex; t < clusterTriangles(cluster); t += gl_WorkGroupSize.x)
		decideChild(0u, t, baseChild(t));
	barrier();
	if (tessellated == 0u)
		return false;
	if (gl_LocalInvocationIndex == 0u)
		takeChildren();
	barrier();
	if (args.lists != 0u)
		for (uint t = gl_LocalInvocationIndex; t < clusterTriangles(cluster); t += gl_WorkGroupSize.x)
			writeChild(t, baseChild(t));
	return true;
}

// The children of the triangle at this depth.
void takeCut(uint depth)
{
	beginChildren(depth);
	Cut cut = cutAt(depth);
	for (uint v = gl_LocalInvocationIndex; v < patternVertices(cut.pattern); v += gl_WorkGroupSize.x)
	{
		ClassifiedCorner vertex = cutVertex(cut, v);
		domains[v] = vertex.domain;
		relative[v] = vertex.relative;
	}
	barrier();
	for (uint t = gl_LocalInvocationIndex; t < patternTriangles(cut.pattern); t += gl_WorkGroupSize.x)
		decideChild(depth, t, cutChild(cut, t));
	barrier();
	if (gl_LocalInvocationIndex == 0u)
		takeChildren();
	barrier();
	if (args.lists != 0u)
		for (uint t = gl_LocalInvocationIndex; t < patternTriangles(cut.pattern); t += gl_WorkGroupSize.x)
			writeChild(t, cutChild(cut, t));
}

// Takes the next child of this depth that is still to be cut and makes it the triangle of the next depth. One lane.
void takeNextChild(uint depth)
{
	next_child = NO_INDEX;
	for (uint word = 0u; word < 4u && next_child == NO_INDEX; ++word)
		if (pending[depth][word] != 0u)
		{
			uint bit = findLSB(pending[depth][word]);
			pending[depth][word] &= ~(1u << bit);
			next_child = word * 32u + bit;
		}
	if (next_child == NO_INDEX)
		return;
	if (depth + 1u == MAX_SPLIT_LEVELS)
	{
		// Deeper than any list can be followed: this candidate cannot be drawn.
		atomicOr(args.steps.at[step_index].abandoned, 1u);
		stop = 1u;
		return;
	}
	Child child = baseChild(next_child);
	if (depth > 0u)
		child = cutChildAgain(cutAt(depth), next_child);
	uint decision = decideTriangle(child.p, child.q, child.r, view, rule);
	cut_triangles[depth + 1u] = decidedTriangle(decision, child.p.domain, child.q.domain, child.r.domain, visible_index, child.triangle);
}

// Everything below the base triangles.
void walkSplits()
{
	uint depth = 0u;
	for (;;)
	{
		barrier();
		if (gl_LocalInvocationIndex == 0u)
			takeNextChild(depth);
		barrier();
		if (stop != 0u || (next_child == NO_INDEX && depth == 0u))
			return;
		if (next_child == NO_INDEX)
			--depth;
		else
			takeCut(++depth);
	}
}

void loadCluster(uint index)
{
	visible_index = index;
	ClusterRef ref = args.visible_clusters.at[index];
	cluster = args.clusters.at[ref.cluster];
	view = frame_view;
	placement = placementOf(args.instances.at[ref.instance], view);
	if (HAS_CULLING && uint64_t(args.cluster_bounds) != 0ul)
		reach = placedReach(args.cluster_bounds.at[ref.cluster], placement, view);
	barrier();
	for (uint v = gl_LocalInvocationIndex; v < clusterVertices(cluster); v += gl_WorkGroupSize.x)
		cluster_relative[v] = placed(placement, frame_surface.positions.at[cluster.first_vertex + v]);
}

void loadStep(uint step)
{
	step_index = step;
	view.rate_over_focal_squared = args.steps.at[step].rate_over_focal_squared;
	rule = args.steps.at[step].rule;
	barrier();
	if (gl_LocalInvocationIndex == 0u)
	{
		stop = args.lists != 0u ? 0u : atomicOr(args.steps.at[step].abandoned, 0u);
		split_sum = 0u;
		part_sum = 0u;
		vertex_sum = 0u;
		micro_sum = 0u;
	}
	barrier();
}

// --- counting --------------------------------------------------------------------------------------------------------------------

bool isOverfull(uint list) { return args.heads.at[list].wanted > listLimit(list); }

// The finest candidate worth counting; NO_INDEX: everything fits, or no rate can help.
uint firstCandidate()
{
	// Lists of clusters; a cluster that is full stays so at every coarser rate.
	if (isOverfull(LIST_CLUSTER_GROUPS) || isOverfull(LIST_VISIBLE_CLUSTERS) || isOverfull(LIST_FULL_CLUSTERS))
		return NO_INDEX;
	if (isOverfull(LIST_SPLIT_TRIANGLES) || isOverfull(LIST_PART_TRIANGLES) || isOverfull(LIST_MICRO_VERTICES) || isOverfull(LIST_EXPANDED_TRIANGLES))
		return 1u;
	// Packings of a fixed size are filled later: only counting can say now whether they fit.
	bool packings_decide = (args.deciding_lists >> LIST_MICRO_VERTICES & 3u) != 0u;
	return packings_decide || args.counts.at[0].split_count[args.split_levels] != 0u ? 0u : NO_INDEX;
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

void countFull()
{
	if (gl_LocalInvocationIndex != 0u || slice != 0u)
		return;
	atomicAdd(args.steps.at[step_index].full_clusters, 1u);
	atomicAdd(args.steps.at[step_index].full_vertices, clusterVertices(cluster));
	atomicAdd(args.steps.at[step_index].full_micro_triangles, clusterTriangles(cluster));
}

// One unit: a cluster at all candidates of a block. Once full, it is full at every coarser one: chooseStep knows.
void countUnit(uint unit, uint first, Dealing dealing)
{
	slice = unit % dealing.slices;
	slices = dealing.slices;
	loadCluster(unit / dealing.slices % dealing.clusters);
	uint block = unit / dealing.slices / dealing.clusters;
	for (uint step = first + block; step < args.step_count; step += dealing.blocks)
	{
		loadStep(step);
		if (stop != 0u)
			continue;
		if (!takeBaseTriangles())
		{
			countFull();
			return;
		}
		walkSplits();
		barrier();
		if (gl_LocalInvocationIndex == 0u)
			flushSums();
	}
}

void countCandidates(uint first)
{
	Dealing dealing = dealingOf(args.step_count - first);
	uint units = dealing.clusters * dealing.blocks * dealing.slices;
	for (uint unit = gl_WorkGroupID.x; unit < units; unit += gl_NumWorkGroups.x)
		countUnit(unit, first, dealing);
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
	args.counts.at[0].levels_missing = args.counts.at[0].split_count[args.split_levels];
	args.counts.at[0].full_cluster_triangles = 0u;
	for (uint level = 0u; level < MAX_SPLIT_LEVELS; ++level)
		args.counts.at[0].split_count[level] = 0u;
	for (uint list = LIST_FULL_CLUSTERS; list < LIST_COUNT; ++list)
		emptyList(list);
}

// The last workgroup to finish counting chooses the finest candidate that fits. None: the lists stay as they are, overfull.
void chooseStep(uint first)
{
	uint blocks = dealingOf(args.step_count - first).blocks;
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
	if (chosen > 0u || args.counts.at[0].split_count[args.split_levels] != 0u)
		grant(chosen);
}

void search(uint first)
{
	countCandidates(first);
	memoryBarrierBuffer();
	barrier();
	if (gl_LocalInvocationIndex == 0u)
		is_last = atomicAdd(args.counts.at[0].search_finished, 1u) + 1u == gl_NumWorkGroups.x ? 1u : 0u;
	barrier();
	memoryBarrierBuffer();
	if (is_last != 0u)
		chooseStep(first);
}

// --- listing ---------------------------------------------------------------------------------------------------------------------

void listUnit(uint unit, Dealing dealing)
{
	slice = unit % dealing.slices;
	slices = dealing.slices;
	loadCluster(unit / dealing.slices);
	loadStep(args.counts.at[0].rate_step);
	if (takeBaseTriangles())
		walkSplits();
	else if (slice == 0u && gl_LocalInvocationIndex == 0u)
	{
		uint slot = reserveEntries(args.heads, LIST_FULL_CLUSTERS, 1u);
		listFullCluster(args.heads, args.counts, args.full_clusters, slot, visible_index, cluster);
	}
}

void listAgain()
{
	Dealing dealing = dealingOf(1u);
	uint units = dealing.clusters * dealing.slices;
	for (uint unit = gl_WorkGroupID.x; unit < units; unit += gl_NumWorkGroups.x)
		listUnit(unit, dealing);
}

void main()
{
	if (args.lists != 0u)
	{
		if (args.counts.at[0].listed_again != 0u)
			listAgain();
		return;
	}
	uint first = firstCandidate();
	if (first < args.step_count)
		search(first);
}
