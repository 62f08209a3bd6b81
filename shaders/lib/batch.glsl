// A batch of part triangles in one workgroup of at least BATCH_MAX_PARTS threads: which part owns which micro-vertex and
// micro-triangle. Used by every stage that evaluates, draws or expands parts.
#ifndef TESSERA_LIB_BATCH
#define TESSERA_LIB_BATCH
#include "shared/lists.h"
#include "shared/raster_inputs.h"

// Pattern of each part, and 1 when its triangles are emitted with two corners exchanged.
shared PatternRange part_patterns[BATCH_MAX_PARTS];
shared uint part_turned[BATCH_MAX_PARTS];
// Sums of the parts before each: vertices in the low, triangles in the high half.
shared uint part_sums[BATCH_MAX_PARTS + 1u];

PatternRange patternOf(RasterInputs inputs, DomainPiece piece)
{
	return inputs.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
}

// Inclusive scan of every part's size. Ends with a barrier.
void scanParts(uint size)
{
	uint lane = gl_LocalInvocationIndex;
	if (lane == 0u)
		part_sums[0] = 0u;
	if (lane < BATCH_MAX_PARTS)
		part_sums[lane + 1u] = size;
	barrier();
	for (uint step = 1u; step < BATCH_MAX_PARTS; step *= 2u)
	{
		uint before = lane >= step && lane < BATCH_MAX_PARTS ? part_sums[lane + 1u - step] : 0u;
		barrier();
		if (lane < BATCH_MAX_PARTS)
			part_sums[lane + 1u] += before;
		barrier();
	}
}

// Reads the layout of a batch. Ends with a barrier.
void loadBatch(RasterInputs inputs, uint batch)
{
	uint lane = gl_LocalInvocationIndex;
	uint size = 0u;
	if (lane < batchCount(batch))
	{
		DomainPiece piece = unpackTriangle(inputs.part_triangles.at[batchFirst(batch) + lane]);
		PatternRange pattern = patternOf(inputs, piece);
		uint turned = piece.mirror;
		if (HAS_MIRRORED_INSTANCES)
			turned ^= inputs.instances.at[inputs.visible_clusters.at[piece.visible_cluster].instance].mirrored;
		part_patterns[lane] = pattern;
		part_turned[lane] = turned;
		size = patternVertices(pattern) | (patternTriangles(pattern) << 16);
	}
	scanParts(size);
}

uint batchVertices() { return part_sums[BATCH_MAX_PARTS] & 0xffffu; }
uint batchTriangles() { return part_sums[BATCH_MAX_PARTS] >> 16; }

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

// Micro-triangle `index` of a batch.
MicroTriangle batchTriangle(RasterInputs inputs, uint index, uint batch)
{
	uint owner = owningPart(index, 16u);
	uint triangle = index - (part_sums[owner] >> 16);
	MicroTriangle result;
	result.vertices = patternTriangle(triangle, part_patterns[owner], inputs.table, part_turned[owner]) + (part_sums[owner] & 0xffffu);
	result.payload = packPayload(KIND_PART_TRIANGLE, batchFirst(batch) + owner, triangle);
	return result;
}

#endif
