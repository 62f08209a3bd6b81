// A batch of part triangles in one workgroup of at least STAGED_PARTS threads: which part owns which micro-vertex and
// micro-triangle. Used by every stage that evaluates, draws or expands parts.
#ifndef TESSERA_LIB_BATCH
#define TESSERA_LIB_BATCH
#include "shared/lists.h"
#include "shared/raster_inputs.h"

// Parts that a batch can have here; an includer may define fewer before.
#ifndef STAGED_PARTS
#define STAGED_PARTS BATCH_MAX_PARTS
#endif

// First triangle and vertex of its pattern in the table, 16 bits each; 1 when its triangles are emitted with two
// corners exchanged.
shared uint part_patterns[STAGED_PARTS];
shared uint part_turned[STAGED_PARTS];
shared uint part_indices[STAGED_PARTS];  // into part_triangles
// Micro-vertices before each part in the low, micro-triangles in the high half; all ones past the last.
shared uint part_sums[STAGED_PARTS];

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
}

// The part that owns entry `index` of the half of the sums that starts at bit `shift`.
uint owningPart(uint index, uint shift)
{
	uint low = 0u;
	for (uint step = STAGED_PARTS / 2u; step > 0u; step /= 2u)
		if (((part_sums[low + step] >> shift) & 0xffffu) <= index)
			low += step;
	return low;
}

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
