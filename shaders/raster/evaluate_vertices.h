// Arguments of evaluate_vertices.
#ifndef TESSERA_RASTER_EVALUATE_VERTICES_H
#define TESSERA_RASTER_EVALUATE_VERTICES_H
#include "shared/lists.h"
#include "shared/raster_inputs.h"

SHARED_BEGIN

struct EvaluateVerticesArgs
{
	RasterInputs inputs;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(Batch) batches;  // 0 when nothing is tessellated
	GPU_PTR(vec4) vertices;  // clip coordinates; relative to the eye where rays are traced
	GPU_PTR(uint) indices;   // 0 unless drawn indexed or traced
	uint traced_triangles;   // that what rays are traced through is built of; 0: no rays
	uint unused;
};
SHARED_LAYOUT(EvaluateVerticesArgs, 128, unused, 124)

SHARED_END

#endif
