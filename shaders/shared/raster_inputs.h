// raster_inputs.h: what every producer of visibility reads, beside lib/frame_data.glsl, to turn list entries into micro-vertices.
#ifndef TESSERA_SHARED_RASTER_INPUTS_H
#define TESSERA_SHARED_RASTER_INPUTS_H
#include "shared/lists.h"
#include "shared/pattern.h"
#include "shared/surface.h"
#include "shared/visibility.h"

SHARED_BEGIN

struct RasterInputs
{
	GPU_PTR(InstanceRecord) instances;
	GPU_PTR(ClusterRecord) clusters;
	GPU_PTR(ClusterRef) visible_clusters;
	GPU_PTR(DomainTriangle) part_triangles;  // 0 when nothing is tessellated
	GPU_PTR(PartPlace) part_places;          // in the order of batches
	GPU_PTR(uint) material_flags;            // MATERIAL_*, per material
	TableView table;
};
SHARED_LAYOUT(RasterInputs, 72, table, 48)

#define MATERIAL_DOUBLE_SIDED 1u

SHARED_END

#endif
