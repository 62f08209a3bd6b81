// Back faces of single-sided materials are never shown. Where all materials agree, fixed-function culling does it, but where that is not by the
// rounded corners that pixels are covered by (SIDES_IN_FRAGMENTS).
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

bool isSingleSidedCluster(RasterInputs inputs, uint cluster)
{
	return (inputs.material_flags.at[inputs.clusters.at[cluster].material] & MATERIAL_DOUBLE_SIDED) == 0u;
}

bool isSingleSided(RasterInputs inputs, uint payload)
{
	return isSingleSidedCluster(inputs, inputs.visible_clusters.at[payloadCluster(inputs, payload)].cluster);
}

// For fragments: true when this side of the triangle is not shown.
bool isHiddenSide(RasterInputs inputs, uint payload, bool front)
{
	if (front || !(HAS_MIXED_SIDES || SIDES_IN_FRAGMENTS))
		return false;
	return !HAS_MIXED_SIDES || isSingleSided(inputs, payload);
}

#endif
