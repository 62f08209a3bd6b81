// A batch of part triangles in one workgroup of at least BATCH_MAX_PARTS threads: which part owns which micro-vertex and
// micro-triangle. Used by every stage that evaluates, draws or expands parts.
#ifndef TESSERA_LIB_BATCH
#define TESSERA_LIB_BATCH
#include "shared/lists.h"
#include "shared/raster_inputs.h"

// Pattern of each part, and 1 when its triangles are emitted with two corners exchanged.
shared PatternRange part_patterns[BATCH_MAX_PARTS];
shared uint part_turned[BATCH_MAX_PARTS];
// Micro-vertices before each part in the low, micro-triangles in the high half; all ones past the last.
shared uint part_sums[BATCH_MAX_PARTS];

PatternRange patternOf(RasterInputs inputs, DomainPiece piece)
{
	return inputs.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
}

// One lane a part.
void loadPart(RasterInputs inputs, uint lane, uint part, uint first, DomainPiece piece)
{
	uint turned = piece.mirror;
	if (HAS_MIRRORED_INSTANCES)
		turned ^= inputs.instances.at[inputs.visible_clusters.at[piece.visible_cluster].instance].mirrored;
	part_patterns[lane] = patternOf(inputs, piece);
	part_turned[lane] = turned;
	part_sums[lane] = inputs.part_offsets.at[part] - inputs.part_offsets.at[first];
}

// Reads the layout of a batch. Ends with a barrier.
void loadBatch(RasterInputs inputs, uint batch)
{
	uint lane = gl_LocalInvocationIndex;
	uint first = batchFirst(batch);
	if (lane < BATCH_MAX_PARTS)
		part_sums[lane] = 0xffffffffu;
	if (lane < batchCount(batch))
		loadPart(inputs, lane, first + lane, first, unpackTriangle(inputs.part_triangles.at[first + lane]));
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
MicroTriangle batchTriangle(RasterInputs inputs, uint index, uint owner, uint batch)
{
	uint triangle = index - (part_sums[owner] >> 16);
	MicroTriangle result;
	result.vertices = patternTriangle(triangle, part_patterns[owner], inputs.table, part_turned[owner]) + (part_sums[owner] & 0xffffu);
	result.payload = packPayload(KIND_PART_TRIANGLE, batchFirst(batch) + owner, triangle);
	return result;
}

#endif
