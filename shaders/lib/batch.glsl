// A batch of part triangles in one workgroup of at least STAGED_PARTS threads: which part owns which micro-vertex and
// micro-triangle. Used by every stage that evaluates, draws or expands parts.
#ifndef TESSERA_LIB_BATCH
#define TESSERA_LIB_BATCH
#include "shared/lists.h"
#include "shared/raster_inputs.h"

// What a batch can have here; an includer may define its own before. Vertices and triangles are multiples of 32.
#ifndef STAGED_PARTS
#define STAGED_PARTS BATCH_MAX_PARTS
#define STAGED_VERTICES BATCH_MAX_VERTICES
#define STAGED_TRIANGLES BATCH_MAX_TRIANGLES
#endif

// First triangle and vertex of its pattern in the table, 16 bits each; 1 when its triangles are emitted with two
// corners exchanged.
shared uint part_patterns[STAGED_PARTS];
shared uint part_turned[STAGED_PARTS];
shared uint part_indices[STAGED_PARTS];  // into part_triangles
// Micro-vertices before each part in the low, micro-triangles in the high half; all ones past the last.
shared uint part_sums[STAGED_PARTS];

// Per block of 32 micro-vertices, then per block of 32 micro-triangles: a bit for each that is its part's first, and the parts that begin before.
const uint VERTEX_BLOCKS = STAGED_VERTICES / 32u;
const uint OWNER_BLOCKS = VERTEX_BLOCKS + STAGED_TRIANGLES / 32u;
shared uint owner_starts[OWNER_BLOCKS];
shared uint owner_before[OWNER_BLOCKS];

PatternRange patternOf(RasterInputs inputs, DomainPiece piece)
{
	return inputs.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
}

// The pattern of a staged part; without its counts.
PatternRange partPattern(uint part) { return PatternRange(part_patterns[part] & 0xffffu, part_patterns[part] >> 16, 0u, 0u); }

// One lane a part.
void loadPart(RasterInputs inputs, uint part, PartPlace place, uint first_offsets, DomainPiece piece)
{
	uint turned = piece.mirror;
	if (HAS_MIRRORED_INSTANCES)
		turned ^= inputs.instances.at[inputs.visible_clusters.at[piece.visible_cluster].instance].mirrored;
	PatternRange pattern = patternOf(inputs, piece);
	part_patterns[part] = pattern.first_triangle | (pattern.first_vertex << 16);
	part_turned[part] = turned;
	part_indices[part] = place.part;
	part_sums[part] = place.offsets - first_offsets;
}

// Once part_sums are there: what vertexOwner and triangleOwner look up.
void loadOwners()
{
	// From the last lane down: the first ones have other work at that time.
	for (uint block = gl_WorkGroupSize.x - 1u - gl_LocalInvocationIndex; block < OWNER_BLOCKS; block += gl_WorkGroupSize.x)
	{
		uint shift = block < VERTEX_BLOCKS ? 0u : 16u;
		uint number = block < VERTEX_BLOCKS ? block : block - VERTEX_BLOCKS;
		uint starts = 0u, before = 0u;
		for (uint part = 0u; part < STAGED_PARTS; ++part)
		{
			uint start = (part_sums[part] >> shift) & 0xffffu;
			starts |= start >> 5 == number ? 1u << (start & 31u) : 0u;
			before += start < 32u * number ? 1u : 0u;
		}
		owner_starts[block] = starts;
		owner_before[block] = before;
	}
}

// Reads the layout of a batch. Ends with a barrier.
void loadBatch(RasterInputs inputs, uint batch)
{
	uint lane = gl_LocalInvocationIndex;
	uint first = batchFirst(batch);
	if (lane < STAGED_PARTS)
		part_sums[lane] = 0xffffffffu;
	if (lane < batchCount(batch))
	{
		PartPlace place = inputs.part_places.at[first + lane];
		loadPart(inputs, lane, place, inputs.part_places.at[first].offsets, unpackTriangle(inputs.part_triangles.at[place.part]));
	}
	barrier();
	loadOwners();
	barrier();
}

uint ownerIn(uint block, uint index)
{
	// Parts that begin at this entry or before it: at least one does.
	return owner_before[block] + uint(bitCount(owner_starts[block] << (31u - (index & 31u)))) - 1u;
}

// The part that owns a micro-vertex or a micro-triangle of the batch.
uint vertexOwner(uint index) { return ownerIn(index >> 5, index); }
uint triangleOwner(uint index) { return ownerIn(VERTEX_BLOCKS + (index >> 5), index); }

struct MicroTriangle
{
	uvec3 vertices;  // within the batch
	uint payload;
};

// Micro-triangle `index` of a batch, of part `owner`.
MicroTriangle batchTriangle(RasterInputs inputs, uint index, uint owner)
{
	uint triangle = index - (part_sums[owner] >> 16);
	MicroTriangle result;
	result.vertices = patternTriangle(triangle, partPattern(owner), inputs.table, part_turned[owner]) + (part_sums[owner] & 0xffffu);
	result.payload = packPayload(KIND_PART_TRIANGLE, part_indices[owner], triangle);
	return result;
}

#endif
