// Back faces of single-sided materials are never shown. Where all materials agree, fixed-function culling does it.
#ifndef TESSERA_LIB_SIDES
#define TESSERA_LIB_SIDES
#include "shared/raster_inputs.h"

uint payloadCluster(RasterInputs inputs, uint payload)
{
	uint index = payloadIndex(payload);
	if (payloadKind(payload) == KIND_PART_TRIANGLE)
		return unpackTriangle(inputs.part_triangles.at[index]).visible_cluster;
	return index;
}

bool isSingleSided(RasterInputs inputs, uint payload)
{
	ClusterRef ref = inputs.visible_clusters.at[payloadCluster(inputs, payload)];
	return (inputs.material_flags.at[inputs.clusters.at[ref.cluster].material] & MATERIAL_DOUBLE_SIDED) == 0u;
}

#endif
