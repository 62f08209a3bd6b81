// A batch of part triangles in one workgroup of at least BATCH_MAX_PARTS threads: who owns which vertex and triangle, and
// what the micro-vertices are. Used by every stage that rasterises or expands parts.
#ifndef TESSERA_LIB_BATCH
#define TESSERA_LIB_BATCH
#include "shared/lists.h"
#include "shared/raster_inputs.h"

struct BatchPart
{
	DomainTriangle record;
	BaseTriangle base;
	Placement placement;
	PatternRange pattern;
	uint turned;  // 1: triangles are emitted with two corners exchanged
};

shared BatchPart parts[BATCH_MAX_PARTS];
// Sums of the parts before each: vertices in the low, triangles in the high half.
shared uint part_sums[BATCH_MAX_PARTS + 1u];

BatchPart loadPart(RasterInputs inputs, uint index)
{
	BatchPart part;
	part.record = inputs.part_triangles.at[index];
	DomainPiece piece = unpackTriangle(part.record);
	ClusterRef ref = inputs.visible_clusters.at[piece.visible_cluster];
	InstanceRecord instance = inputs.instances.at[ref.instance];
	part.base = baseTriangle(inputs.surface.at[0], inputs.clusters.at[ref.cluster], piece.triangle);
	part.placement = placementOf(instance, inputs.view.at[0]);
	part.pattern = inputs.table.patterns.at[patternIndex(piece.a, piece.b, piece.c)];
	part.turned = HAS_MIRRORED_INSTANCES ? piece.mirror ^ instance.mirrored : piece.mirror;
	return part;
}

// Loads the parts of a batch and sums their sizes. Ends with a barrier.
void loadBatch(RasterInputs inputs, uint batch)
{
	uint lane = gl_LocalInvocationIndex;
	uint size = 0u;
	if (lane < batchCount(batch))
	{
		parts[lane] = loadPart(inputs, batchFirst(batch) + lane);
		size = patternVertices(parts[lane].pattern) | (patternTriangles(parts[lane].pattern) << 16);
	}
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

// Micro-vertex `index` of the batch, clip coordinates.
vec4 batchVertex(RasterInputs inputs, uint index)
{
	uint owner = owningPart(index, 0u);
	DomainPiece piece = unpackTriangle(parts[owner].record);
	uint edge_flags = triangleEdgeFlags(parts[owner].base.flags);
	DomainPoint point = patternPoint(piece, index - (part_sums[owner] & 0xffffu), parts[owner].pattern, inputs.table, edge_flags);
	View view = inputs.view.at[0];
	SurfacePoint surface_point = surfacePoint(inputs.surface.at[0], parts[owner].base, point, parts[owner].placement, view);
	return clipPosition(placed(parts[owner].placement, surface_point.displaced), view);
}

struct MicroTriangle
{
	uvec3 vertices;  // within the batch
	uint payload;
};

// Micro-triangle `index` of the batch whose first part is `first_part`.
MicroTriangle batchTriangle(RasterInputs inputs, uint index, uint first_part)
{
	uint owner = owningPart(index, 16u);
	uint triangle = index - (part_sums[owner] >> 16);
	MicroTriangle result;
	result.vertices = patternTriangle(triangle, parts[owner].pattern, inputs.table, parts[owner].turned) + (part_sums[owner] & 0xffffu);
	result.payload = packPayload(KIND_PART_TRIANGLE, first_part + owner, triangle);
	return result;
}

#endif
