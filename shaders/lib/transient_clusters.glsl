// Transient clusters: which of a window's parts are built together, one lane a part, and their triangles and vertices side by side.
// The includer has `args` of ListClustersArgs and workgroups of BATCH_WINDOW threads.
#ifndef TESSERA_LIB_TRANSIENT_CLUSTERS
#define TESSERA_LIB_TRANSIENT_CLUSTERS

// Per lane: what its part is built together with (keyOf); three cluster vertices, 7 bits each; a bit per corner that is the first with its vertex;
// triangles | vertices << 16 that the lane adds.
shared uint keys[BATCH_WINDOW];
shared uint corners[BATCH_WINDOW];
shared uint first_corners[BATCH_WINDOW];
shared uint sizes[BATCH_WINDOW];
// Of the lane that leads a transient cluster: its ranges.
shared uint cluster_triangles[BATCH_WINDOW];
shared uint cluster_vertices[BATCH_WINDOW];

const uint KEY_UNITS = 0x80000000u;
const uint KEY_GROUP = 0x40000000u;
const uint MAX_CORNERS = 0x1fffffu;

bool isWhole(DomainPiece piece)
{
	return piece.c0 == domainCorner(0u) && piece.c1 == domainCorner(1u) && piece.c2 == domainCorner(2u);
}

// What the part is built together with; NO_INDEX: nothing.
uint keyOf(DomainPiece piece, uint instance)
{
	if (HAS_TRANSIENT_UNITS && piece.a == 1u && isWhole(piece))
		return KEY_UNITS | piece.visible_cluster;
	return HAS_TRANSIENT_GROUPS && piece.a <= 2u ? KEY_GROUP | instance : NO_INDEX;
}

bool isUnits(uint key) { return key != NO_INDEX && (key & KEY_UNITS) != 0u; }

// Lanes that may be built together with this one begin here; they are a power of two.
uint blockOf(uint lane, uint key) { return lane & ~((isUnits(key) ? UNITS_PER_CLUSTER : GROUP_PARTS) - 1u); }
uint blockEnd(uint lane, uint key) { return blockOf(lane, key) + (isUnits(key) ? UNITS_PER_CLUSTER : GROUP_PARTS); }

uint cornerIn(uint packed, uint corner) { return (packed >> (7u * corner)) & 0x7fu; }

// A bit per corner of the lane's triangle whose vertex no triangle before it in its cluster has, nor a corner before it.
uint firstCorners(uint lane)
{
	uint mine = corners[lane];
	uint bits = 1u;
	bits |= cornerIn(mine, 1u) != cornerIn(mine, 0u) ? 2u : 0u;
	bits |= cornerIn(mine, 2u) != cornerIn(mine, 0u) && cornerIn(mine, 2u) != cornerIn(mine, 1u) ? 4u : 0u;
	for (uint i = blockOf(lane, keys[lane]); i < lane; ++i)
		if (keys[i] == keys[lane])
			for (uint c = 0u; c < 9u; ++c)
				if (cornerIn(mine, c / 3u) == cornerIn(corners[i], c % 3u))
					bits &= ~(1u << (c / 3u));
	return bits;
}

// Where the vertices of the lane's triangle lie in its cluster.
uvec3 unitVertices(uint lane)
{
	uvec3 places = uvec3(0u);
	uint before = 0u;
	for (uint i = blockOf(lane, keys[lane]); i <= lane; ++i)
	{
		if (keys[i] != keys[lane])
			continue;
		for (uint c = 0u; c < 3u; ++c)
		{
			if ((first_corners[i] & (1u << c)) == 0u)
				continue;
			for (uint mine = 0u; mine < 3u; ++mine)
				if (cornerIn(corners[lane], mine) == cornerIn(corners[i], c))
					places[mine] = before;
			++before;
		}
	}
	return places;
}

// The lanes that the lane's part is built together with.
struct Members
{
	uint leader;
	uint before;  // triangles | vertices << 16 of those before the lane
	uint all;     // of all
};

Members membersOf(uint lane)
{
	Members members = Members(lane, 0u, 0u);
	for (uint i = blockOf(lane, keys[lane]); i < blockEnd(lane, keys[lane]); ++i)
		if (keys[i] == keys[lane])
		{
			members.leader = min(members.leader, i);
			members.before += i < lane ? sizes[i] : 0u;
			members.all += sizes[i];
		}
	return members;
}

void writeTriangle(ClusterWork work, uint triangle, uvec3 vertices, uint payload)
{
	work.indices.at[3u * triangle] = vertices.x;
	work.indices.at[3u * triangle + 1u] = vertices.y;
	work.indices.at[3u * triangle + 2u] = vertices.z;
	work.payloads.at[triangle] = payload;
}

// The part's micro-triangles and micro-vertices, into the ranges of its cluster.
void writeMember(ClusterWork work, Members members, uint part, DomainPiece piece, PatternRange pattern, uint first_micro)
{
	uint first_triangle = cluster_triangles[members.leader];
	uint first_vertex = cluster_vertices[members.leader];
	if (first_triangle + (members.all & 0xffffu) > work.reserved[RESERVED_TRANSIENT_TRIANGLES] ||
	    first_vertex + (members.all >> 16) > work.reserved[RESERVED_TRANSIENT_VERTICES])
		return;
	uint triangle = first_triangle + (members.before & 0xffffu);
	if (isUnits(keys[gl_LocalInvocationIndex]))
	{
		uvec3 places = unitVertices(gl_LocalInvocationIndex);
		for (uint c = 0u; c < 3u; ++c)
			if ((first_corners[gl_LocalInvocationIndex] & (1u << c)) != 0u)
				work.vertices.at[first_vertex + places[c]] = args.vertices.at[first_micro + c];
		uvec3 turned = patternTriangle(0u, pattern, args.inputs.table, piece.mirror);
		writeTriangle(work, triangle, uvec3(places[turned.x], places[turned.y], places[turned.z]), packPayload(KIND_PART_TRIANGLE, part, 0u));
		return;
	}
	uint vertex = members.before >> 16;
	for (uint v = 0u; v < patternVertices(pattern); ++v)
		work.vertices.at[first_vertex + vertex + v] = args.vertices.at[first_micro + v];
	for (uint t = 0u; t < patternTriangles(pattern); ++t)
		writeTriangle(work, triangle + t, patternTriangle(t, pattern, args.inputs.table, piece.mirror) + vertex,
		              packPayload(KIND_PART_TRIANGLE, part, t));
}

// What the lane adds to a transient cluster. Ends with a barrier.
void loadMember(DomainPiece piece, PatternRange pattern, ClusterRef ref, bool exists)
{
	uint lane = gl_LocalInvocationIndex;
	keys[lane] = exists ? keyOf(piece, ref.instance) : NO_INDEX;
	sizes[lane] = keys[lane] == NO_INDEX ? 0u : patternTriangles(pattern) | (patternVertices(pattern) << 16);
	if (isUnits(keys[lane]))
	{
		ClusterRecord cluster = args.inputs.clusters.at[ref.cluster];
		corners[lane] = frame_surface.triangles.at[cluster.first_triangle + piece.triangle] & MAX_CORNERS;
	}
	barrier();
	if (isUnits(keys[lane]))
	{
		first_corners[lane] = firstCorners(lane);
		sizes[lane] = 1u | (uint(bitCount(first_corners[lane])) << 16);
	}
	barrier();
}

#endif
