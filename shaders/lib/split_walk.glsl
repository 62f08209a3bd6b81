// Everything that the triangles of a cluster become at one rate, found by one workgroup without lists of split triangles: by the
// functions that cluster_classify and triangle_split use, so the same. rate_search includes it after declaring its args.
//
// Split triangles wait on a stack in shared memory. The workgroup takes children of those on top, one lane a child; what is a
// split triangle itself goes on top. It takes fewer at a time as the stack fills, at last one, so that each level adds one entry
// at most and the room that is kept for that is enough: no level can be missing.
#ifndef TESSERA_LIB_SPLIT_WALK
#define TESSERA_LIB_SPLIT_WALK
#include "lib/classify.glsl"
#include "lib/frame_data.glsl"
#include "lib/full_clusters.glsl"
#include "shared/surface.h"

const uint ALL_ONE = 0x111u;
const uint MOST_STACKED = 384u;  // with all else below 16 KiB, the least that a device has
const uint STACK_ROOM = MOST_STACKED - MAX_SPLIT_LEVELS;
const uint GATHERED = 32u;  // entries whose children are taken at once

// The cluster that the workgroup is at, and the rate.
uint visible_index;
ClusterRecord cluster;
Placement placement;
PlacedReach reach;
View view;
FactorRule rule;
// Where workgroups share a cluster: all decide its base triangles, the first takes them, the children of first cuts are dealt out.
uint slice;
uint slices;

shared vec3 cluster_relative[128];
shared uint base_decisions[128];
shared uint tessellated;
shared DomainTriangle stack[MOST_STACKED];
shared uint stack_states[MOST_STACKED];  // next child to take | level << 8
shared uint stack_count;
shared uint child_counts[GATHERED];
shared uint child_sums[GATHERED + 1u];  // children of the entries above each
// Of the children at hand.
shared uint part_count;
shared uint split_count;
shared uint vertex_count;  // micro-vertices and micro-triangles of the parts
shared uint micro_count;
shared uint first_part;
shared uint first_split;
shared uint stop;  // the rate is given up

// What the includer does with the counts of the children at hand: count them, or take places in the lists. One lane.
void takePlaces();

struct Child
{
	ClassifiedCorner corners[3];
	uint triangle;  // of the cluster
	uint level;     // 0: a base triangle
	uint decision;  // DECISION_CULLED also where there is nothing
};

Child noChild()
{
	Child child;
	for (uint corner = 0u; corner < 3u; ++corner)
		child.corners[corner] = ClassifiedCorner(domainCorner(corner), vec3(0.0));
	child.triangle = 0u;
	child.level = 0u;
	child.decision = DECISION_CULLED;
	return child;
}

void loadCluster(uint index)
{
	visible_index = index;
	ClusterRef ref = args.visible_clusters.at[index];
	cluster = args.clusters.at[ref.cluster];
	view = frame_view;
	placement = placementForEdges(args.instances.at[ref.instance], ref.instance, frame_surface, view);
	if (HAS_CULLING && uint64_t(args.cluster_bounds) != 0ul)
		reach = placedReach(args.cluster_bounds.at[ref.cluster], placement, view);
	barrier();
	for (uint v = gl_LocalInvocationIndex; v < clusterVertices(cluster); v += gl_WorkGroupSize.x)
		cluster_relative[v] = placed(placement, frame_surface.positions.at[cluster.first_vertex + v]);
}

PatternRange patternOfPiece(DomainPiece piece) { return args.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)]; }

bool isUnseen(Child child)
{
	uint cull_frustum = uint64_t(args.cluster_bounds) != 0ul ? 1u : 0u;
	return isOutOfView(child.corners[0], child.corners[1], child.corners[2], reach, cull_frustum, view);
}

uint decisionOf(Child child)
{
	EdgeBase base = EdgeBase(cluster.first_triangle + child.triangle, placement.inverse_scale_squared, placement.triangle_reach,
	                         placement.hidden_squared);
	return decideTriangle(base, child.corners[0], child.corners[1], child.corners[2], view, rule);
}

Child baseChild(uint t)
{
	Child child = noChild();
	child.triangle = t;
	if (t >= clusterTriangles(cluster))
		return child;
	uint triangle = frame_surface.triangles.at[cluster.first_triangle + t];
	for (uint corner = 0u; corner < 3u; ++corner)
		child.corners[corner].relative = cluster_relative[triangleVertex(triangle, corner)];
	return child;
}

// Child t of a split triangle.
Child cutChild(DomainTriangle record, uint t, uint level)
{
	DomainPiece piece = unpackTriangle(record);
	PatternRange pattern = patternOfPiece(piece);
	uint triangle = frame_surface.triangles.at[cluster.first_triangle + piece.triangle];
	vec3 p0 = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, 0u)];
	vec3 p1 = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, 1u)];
	vec3 p2 = frame_surface.positions.at[cluster.first_vertex + triangleVertex(triangle, 2u)];
	uvec3 vertices = patternTriangle(t, pattern, args.table, piece.mirror);
	Child child = noChild();
	for (uint corner = 0u; corner < 3u; ++corner)
	{
		DomainPoint point = patternPoint(piece, vertices[corner], pattern, args.table, triangleEdgeFlags(triangle));
		child.corners[corner] = ClassifiedCorner(point, placed(placement, weightedVec3(p0, p1, p2, domainWeights(point))));
	}
	child.triangle = piece.triangle;
	child.level = level;
	return child;
}

DomainTriangle recordOf(Child child)
{
	return decidedTriangle(child.decision, child.corners[0].domain, child.corners[1].domain, child.corners[2].domain, visible_index, child.triangle);
}

// Counts a child and returns its place among the children at hand; a split triangle goes on the stack.
uint countChild(Child child, DomainTriangle record, bool is_mine)
{
	if ((child.decision & DECISION_SPLIT) != 0u)
	{
		uint entry = atomicAdd(stack_count, 1u);
		stack[entry] = record;
		stack_states[entry] = (child.level + 1u) << 8;
		// Deeper than splitting can go: the rate cannot be drawn.
		if (child.level + 1u == MAX_SPLIT_LEVELS)
			stop = 1u;
		return is_mine ? atomicAdd(split_count, 1u) : 0u;
	}
	if (!is_mine)
		return 0u;
	if (KEEPS_VERTICES)
	{
		PatternRange pattern = patternOfPiece(unpackTriangle(record));
		atomicAdd(vertex_count, patternVertices(pattern));
		atomicAdd(micro_count, patternTriangles(pattern));
	}
	return atomicAdd(part_count, 1u);
}

void writeChild(Child child, DomainTriangle record, uint place)
{
	if ((child.decision & DECISION_SPLIT) != 0u)
	{
		if (first_split + place < args.heads.at[LIST_SPLIT_TRIANGLES].capacity)
			args.split_triangles.at[first_split + place] = record;
	}
	else if (first_part + place < args.heads.at[LIST_PART_TRIANGLES].capacity)
		args.part_triangles.at[first_part + place] = record;
}

// Takes one child per lane. All lanes together; begins and ends with a barrier.
void takeChildren(Child child, bool lists)
{
	barrier();
	if (gl_LocalInvocationIndex == 0u)
	{
		part_count = 0u;
		split_count = 0u;
		vertex_count = 0u;
		micro_count = 0u;
	}
	barrier();
	bool is_there = child.decision != DECISION_CULLED;
	bool is_mine = child.level > 0u || slice == 0u;
	DomainTriangle record = recordOf(child);
	uint place = is_there ? countChild(child, record, is_mine) : 0u;
	barrier();
	if (gl_LocalInvocationIndex == 0u)
		takePlaces();
	barrier();
	if (lists && is_there && is_mine)
		writeChild(child, record, place);
}

uint childrenLeft(uint entry)
{
	return patternTriangles(patternOfPiece(unpackTriangle(stack[entry]))) - (stack_states[entry] & 0xffu);
}

// Says how many children to take next, those of the topmost entries; fills child_sums.
uint gatherChildren()
{
	for (uint i = gl_LocalInvocationIndex; i < GATHERED; i += gl_WorkGroupSize.x)
		child_counts[i] = i < stack_count ? childrenLeft(stack_count - 1u - i) : 0u;
	barrier();
	for (uint i = gl_LocalInvocationIndex; i <= GATHERED; i += gl_WorkGroupSize.x)
	{
		uint sum = 0u;
		for (uint before = 0u; before < i; ++before)
			sum += child_counts[before];
		child_sums[i] = sum;
	}
	barrier();
	uint room = (STACK_ROOM - min(stack_count, STACK_ROOM)) / 2u;
	return min(child_sums[GATHERED], clamp(room, 1u, gl_WorkGroupSize.x));
}

// The lane's child among the `count` to take, nothing where it has none.
Child gatheredChild(uint count, out bool is_there)
{
	uint index = gl_LocalInvocationIndex;
	is_there = index < count;
	if (!is_there)
		return noChild();
	uint i = 0u;
	for (uint more = GATHERED / 2u; more > 0u; more /= 2u)
		if (child_sums[i + more] <= index)
			i += more;
	uint entry = stack_count - 1u - i;
	uint t = (stack_states[entry] & 0xffu) + index - child_sums[i];
	uint level = stack_states[entry] >> 8;
	// The children of a first cut are dealt out.
	is_there = level > 1u || t % slices == slice;
	return is_there ? cutChild(stack[entry], t, level) : noChild();
}

// Takes entries that have no children left from the stack. One lane.
void dropTaken(uint count)
{
	uint done = 0u;
	while (done < GATHERED && done < stack_count && child_sums[done + 1u] <= count)
		++done;
	stack_count -= done;
	if (stack_count > 0u && count > child_sums[done])
		stack_states[stack_count - 1u] += count - child_sums[done];
}

// Takes the base triangles of the loaded cluster and everything below them; false when every factor of it is 1: nothing is taken then.
// One loop, so that the code of a child is there once: first the base triangles are decided, whether or not they are needed one by
// one; then they are taken; then what is on the stack.
bool walkCluster(bool lists)
{
	uint triangles = clusterTriangles(cluster);
	uint rounds = (triangles + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
	barrier();
	if (gl_LocalInvocationIndex == 0u)
	{
		tessellated = 0u;
		stack_count = 0u;
	}
	barrier();
	for (uint turn = 0u;; ++turn)
	{
		bool decides = turn < rounds || turn >= 2u * rounds;
		bool is_there = true;
		Child child;
		if (turn < 2u * rounds)
		{
			uint t = turn % rounds * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
			child = baseChild(t);
			is_there = t < triangles;
			if (!decides && is_there)
				child.decision = base_decisions[t];
		}
		else
		{
			if (stack_count == 0u || stop != 0u)
				return true;
			uint count = gatherChildren();
			child = gatheredChild(count, is_there);
			barrier();
			if (gl_LocalInvocationIndex == 0u)
				dropTaken(count);
		}
		if (decides && is_there)
		{
			child.decision = decisionOf(child);
			if (child.decision != ALL_ONE)
				tessellated = 1u;
			if (isUnseen(child))
				child.decision = DECISION_CULLED;
		}
		if (turn < rounds)
		{
			if (is_there)
				base_decisions[child.triangle] = child.decision;
			barrier();
			if (turn + 1u == rounds && tessellated == 0u)
				return false;
		}
		else
			takeChildren(child, lists);
		barrier();
	}
}

#endif
