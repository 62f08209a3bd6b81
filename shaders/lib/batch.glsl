// A batch of part triangles in one workgroup of at least BATCH_MAX_PARTS threads: which part owns which micro-vertex and
// micro-triangle. Used by every stage that evaluates, draws or expands parts.
#ifndef TESSERA_LIB_BATCH
#define TESSERA_LIB_BATCH
#include "shared/lists.h"
#include "shared/raster_inputs.h"

// Pattern of each part, and 1 when its triangles are emitted with two corners exchanged.
shared PatternRange part_patterns[BATCH_MAX_PARTS];
shared uint part_turned[BATCH_MAX_PARTS];
shared uint part_indices[BATCH_MAX_PARTS];  // into part_triangles
// Micro-vertices before each part in the low, micro-triangles in the high half; all ones past the last.
shared uint part_sums[BATCH_MAX_PARTS];

PatternRange patternOf(RasterInputs inputs, DomainPiece piece)
{
	return inputs.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
}

// One lane a part.
void loadPart(RasterInputs inputs, uint lane, PartPlace place, uint first_offsets, DomainPiece piece)
{
	uint turned = piece.mirror;
	if (HAS_MIRRORED_INSTANCES)
		turned ^= inputs.instances.at[inputs.visible_clusters.at[piece.visible_cluster].instance].mirrored;
	part_patterns[lane] = patternOf(inputs, piece);
	part_turned[lane] = turned;
	part_indices[lane] = place.part;
	part_sums[lane] = place.offsets - first_offsets;
}

// Reads the layout of a batch. Ends with a barrier.
void loadBatch(RasterInputs inputs, uint batch)
{
	uint lane = gl_LocalInvocationIndex;
	uint first = batchFirst(batch);
	if (lane < BATCH_MAX_PARTS)
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
	for (uint step = BATCH_MAX_PARTS / 2u; step > 0u; step /= 2u)
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
	result.vertices = patternTriangle(triangle, part_patterns[owner], inputs.table, part_turned[owner]) + (part_sums[owner] & 0xffffu);
	result.payload = packPayload(KIND_PART_TRIANGLE, part_indices[owner], triangle);
	return result;
}

#endif
