// The micro-vertices of a batch: what each part's evaluation needs is loaded once per workgroup.
#ifndef TESSERA_LIB_BATCH_VERTICES
#define TESSERA_LIB_BATCH_VERTICES
#include "lib/frame_data.glsl"
#include "lib/batch.glsl"

shared DomainTriangle part_records[BATCH_MAX_PARTS];
shared BaseTriangle part_bases[BATCH_MAX_PARTS];
shared Placement part_placements[BATCH_MAX_PARTS];
shared uint part_materials[BATCH_MAX_PARTS];

// Loads what batchVertex reads; after loadBatch. Ends with a barrier.
void loadBatchParts(RasterInputs inputs, uint batch)
{
	uint lane = gl_LocalInvocationIndex;
	if (lane < batchCount(batch))
	{
		DomainTriangle record = inputs.part_triangles.at[batchFirst(batch) + lane];
		DomainPiece piece = unpackTriangle(record);
		ClusterRef ref = inputs.visible_clusters.at[piece.visible_cluster];
		part_records[lane] = record;
		ClusterRecord cluster = inputs.clusters.at[ref.cluster];
		part_bases[lane] = baseTriangle(frame_surface, cluster, piece.triangle);
		part_materials[lane] = cluster.material;
		part_placements[lane] = placementOf(inputs.instances.at[ref.instance], frame_view);
	}
	barrier();
}

// What micro-vertex `index` of the batch, of part `owner`, is made of.
SurfaceSample batchSample(RasterInputs inputs, uint index, uint owner)
{
	DomainPiece piece = unpackTriangle(part_records[owner]);
	uint edge_flags = triangleEdgeFlags(part_bases[owner].flags);
	DomainPoint point = patternPoint(piece, index - (part_sums[owner] & 0xffffu), part_patterns[owner], inputs.table, edge_flags);
	return sampleAtPoint(frame_surface, part_bases[owner], point);
}

#endif
