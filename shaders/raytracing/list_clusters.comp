// list_clusters: what rays' clusters are made of, and where in memory they go.
//
//   in   full_clusters     FullCluster[]       each is made from its cluster's template
//   in   part_triangles    DomainTriangle[]    each is made from its pattern's template, but:
//                                              those of factor 1 that are whole triangles of one visible cluster are built together,
//                                              so are those of one instance with factors up to 2 (HAS_TRANSIENT_UNITS, HAS_TRANSIENT_GROUPS)
//   in   micro_vertices    vec4[]              relative to the eye; transient clusters get copies, side by side
//   out  ray_inputs        InstantiationInfo[], TransientInfo[], their destinations, vertices and indices
//   out  ray_payloads      uint[]              per triangle of transient clusters
//   out  cluster_counts, instance_clusters     what is wanted; list_structures decides whether all of it fits
//
// One workgroup takes BATCH_WINDOW full clusters or parts at a time, a lane each; a cluster built of several is its first lane's. Ranges are
// taken once per workgroup.
// Host: src/pipeline/raytracing/list_clusters.cpp   Test: tests/gpu/raytracing/clusters_test.cpp
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raytracing/list_clusters.h"

layout(local_size_x = BATCH_WINDOW) in;
layout(push_constant, scalar) uniform Args { ListClustersArgs args; };
#include "lib/transient_clusters.glsl"

shared uint sums[COUNTED_KINDS];
shared uint bases[COUNTED_KINDS];
shared uint entry_instances[BATCH_WINDOW];  // NO_INDEX: the lane has no cluster
shared uint instance_bases[BATCH_WINDOW];

// A cluster that a lane lists.
struct Entry
{
	bool exists;
	bool is_transient;
	uint kind;  // CLUSTER_OF_*
	uint instance;
	uint units;
	uint triangles;
	uint vertices;
};

struct Places
{
	uint slot;
	uint first_triangle;
	uint first_vertex;
	uint data;
	ClusterPlace at;
};

Entry noEntry() { return Entry(false, false, 0u, NO_INDEX, 0u, 0u, 0u); }

// Takes the lane's ranges within the workgroup.
Places takeWithin(Entry entry)
{
	uint first = entry.is_transient ? RESERVED_TRANSIENTS : RESERVED_INSTANTIATIONS;
	Places places;
	places.slot = atomicAdd(sums[first], 1u);
	places.first_triangle = atomicAdd(sums[first + 1u], entry.triangles);
	places.first_vertex = atomicAdd(sums[first + 2u], entry.vertices);
	places.data = atomicAdd(sums[RESERVED_DATA], entry.units);
	atomicAdd(sums[COUNTED_OF_KIND + entry.kind], 1u);
	return places;
}

// Takes the workgroup's ranges of everything that is counted. Ends with a barrier.
void takeForAll(ClusterWork work)
{
	uint lane = gl_LocalInvocationIndex;
	barrier();
	if (lane < COUNTED_KINDS && lane != RESERVED_LARGEST && sums[lane] > 0u)
		bases[lane] = atomicAdd(work.counts.at[0].wanted[lane], sums[lane]);
	barrier();
}

// The place of the lane's cluster among those of its instance. Ends with a barrier.
uint takeOfInstance(ClusterWork work)
{
	uint lane = gl_LocalInvocationIndex;
	uint instance = entry_instances[lane];
	uint leader = lane, before = 0u, count = 0u;
	for (uint i = 0u; i < BATCH_WINDOW && instance != NO_INDEX; ++i)
		if (entry_instances[i] == instance)
		{
			leader = min(leader, i);
			before += i < lane ? 1u : 0u;
			++count;
		}
	if (instance != NO_INDEX && leader == lane)
	{
		uint first = atomicAdd(work.instances.at[instance].count, count);
		atomicMax(work.counts.at[0].wanted[RESERVED_LARGEST], first + count);
		instance_bases[lane] = first;
	}
	barrier();
	return instance_bases[leader] + before;
}

// All lanes together. Ends with a barrier.
Places takePlaces(ClusterWork work, Entry entry)
{
	uint lane = gl_LocalInvocationIndex;
	if (lane < COUNTED_KINDS)
		sums[lane] = 0u;
	entry_instances[lane] = entry.exists ? entry.instance : NO_INDEX;
	barrier();
	Places places;
	if (entry.exists)
		places = takeWithin(entry);
	takeForAll(work);
	uint place = takeOfInstance(work);
	uint first = entry.is_transient ? RESERVED_TRANSIENTS : RESERVED_INSTANTIATIONS;
	places.slot += bases[first];
	places.first_triangle += bases[first + 1u];
	places.first_vertex += bases[first + 2u];
	places.data += bases[RESERVED_DATA];
	places.at = ClusterPlace(entry.instance, place);
	return places;
}

uint64_t dataAddress(ClusterWork work, uint unit) { return work.data + uint64_t(unit) * uint64_t(work.unit_bytes); }

void writeInstantiation(ClusterWork work, Places places, uint id, uint64_t source, uint first_vertex)
{
	if (places.slot >= work.reserved[RESERVED_INSTANTIATIONS])
		return;
	work.instantiations.at[places.slot] = InstantiationInfo(id, 0u, source, uint64_t(args.vertices) + 16u * uint64_t(first_vertex), 16ul);
	work.instantiation_destinations.at[places.slot].bytes = dataAddress(work, places.data);
	work.instantiation_places.at[places.slot] = places.at;
}

Entry instantiationOf(ClusterTemplate source, uint kind, uint instance)
{
	return Entry(true, false, kind, instance, source.units, source.counts & 0xffffu, source.counts >> 16);
}

void listFullClusters(ClusterWork work, uint begin, uint count)
{
	uint index = begin + gl_LocalInvocationIndex;
	Entry entry = noEntry();
	ClusterTemplate source;
	FullCluster full;
	if (index < count)
	{
		full = args.full_clusters.at[index];
		ClusterRef ref = args.inputs.visible_clusters.at[full.visible_cluster];
		source = work.templates.at[ref.cluster];
		entry = instantiationOf(source, CLUSTER_OF_FULL, ref.instance);
	}
	Places places = takePlaces(work, entry);
	if (entry.exists)
		writeInstantiation(work, places, packClusterId(CLUSTER_OF_FULL, full.visible_cluster), source.address, full.first_vertex);
	barrier();
}

void writeTransient(ClusterWork work, Places places, Members members, uint kind)
{
	if (places.slot >= work.reserved[RESERVED_TRANSIENTS])
		return;
	TransientInfo info;
	info.id = packClusterId(kind, places.first_triangle);
	info.flags = 0u;
	info.counts = packTransientCounts(members.all & 0xffffu, members.all >> 16, work.truncated_bits);
	info.geometry = work.geometry;
	info.strides = 4u | (16u << 16);
	info.more_strides = 0u;
	info.indices = uint64_t(work.indices) + 12u * uint64_t(places.first_triangle);
	info.vertices = uint64_t(work.vertices) + 16u * uint64_t(places.first_vertex);
	info.geometries = 0ul;
	info.micromaps = 0ul;
	info.micromap_indices = 0ul;
	work.transients.at[places.slot] = info;
	work.transient_destinations.at[places.slot].bytes = dataAddress(work, places.data);
	work.transient_places.at[places.slot] = places.at;
}

struct Part
{
	DomainPiece piece;
	ClusterRef ref;
	PatternRange pattern;
	uint pattern_index;
	uint first_micro;  // its first micro-vertex
};

// Places are in the order of parts: only occlusion culling changes that, which rays exclude.
Part loadPart(uint window, uint index)
{
	Part part;
	part.piece = unpackTriangle(args.inputs.part_triangles.at[index]);
	part.ref = args.inputs.visible_clusters.at[part.piece.visible_cluster];
	part.pattern_index = patternIndex(part.piece.a, part.piece.b, part.piece.c);
	part.pattern = args.inputs.table.patterns.at[part.pattern_index];
	part.first_micro = args.window_vertices.at[window] + (args.inputs.part_places.at[index].offsets & 0xffffu);
	return part;
}

void listParts(ClusterWork work, uint window, uint part_count)
{
	uint lane = gl_LocalInvocationIndex;
	uint index = window * BATCH_WINDOW + lane;
	Part part;
	if (index < part_count)
		part = loadPart(window, index);
	loadMember(part.piece, part.pattern, part.ref, index < part_count);
	bool is_member = keys[lane] != NO_INDEX;
	Members members = membersOf(lane);
	uint kind = isUnits(keys[lane]) ? CLUSTER_OF_UNITS : CLUSTER_OF_GROUP;
	Entry entry = noEntry();
	ClusterTemplate source;
	if (is_member && members.leader == lane)
		entry = Entry(true, true, kind, part.ref.instance, work.transient_units.at[members.all & 0xffffu], members.all & 0xffffu, members.all >> 16);
	if (index < part_count && !is_member)
	{
		source = work.templates.at[work.scene_clusters + 2u * part.pattern_index + part.piece.mirror];
		entry = instantiationOf(source, CLUSTER_OF_PART, part.ref.instance);
	}
	Places places = takePlaces(work, entry);
	if (entry.exists && !entry.is_transient)
		writeInstantiation(work, places, packClusterId(CLUSTER_OF_PART, index), source.address, part.first_micro);
	if (entry.exists && entry.is_transient)
	{
		writeTransient(work, places, members, kind);
		cluster_triangles[lane] = places.first_triangle;
		cluster_vertices[lane] = places.first_vertex;
	}
	barrier();
	if (is_member)
		writeMember(work, members, index, part.piece, part.pattern, part.first_micro);
	barrier();
}

void main()
{
	if (args.counts.at[0].overflow != 0u)
		return;
	ClusterWork work = args.work.at[0];
	uint full_count = args.heads.at[LIST_FULL_CLUSTERS].wanted;
	for (uint begin = gl_WorkGroupID.x * BATCH_WINDOW; begin < full_count; begin += gl_NumWorkGroups.x * BATCH_WINDOW)
		listFullClusters(work, begin, full_count);
	uint part_count = HAS_TESSELLATION && uint64_t(args.inputs.part_triangles) != 0ul ? args.heads.at[LIST_PART_TRIANGLES].wanted : 0u;
	for (uint window = gl_WorkGroupID.x; window * BATCH_WINDOW < part_count; window += gl_NumWorkGroups.x)
		listParts(work, window, part_count);
}
