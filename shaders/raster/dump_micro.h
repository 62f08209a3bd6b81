// What dump_micro writes, and its arguments.
#ifndef TESSERA_RASTER_DUMP_MICRO_H
#define TESSERA_RASTER_DUMP_MICRO_H
#include "shading/material_record.h"
#include "shared/lists.h"

SHARED_BEGIN

// A micro-vertex. `owner` and the domain point say which: of a batch, owner is the index of its part triangle; of a full
// cluster, owner is the index of the visible cluster, and u is the vertex within the cluster, which several triangles share.
struct DumpVertex
{
	vec3 displaced;  // mesh units
	vec3 normal;     // of the displaced surface, mesh space, not normalised; zero unless normals are wanted
	uint owner;
	uint u;
	uint v;
};
SHARED_LAYOUT(DumpVertex, 36, v, 32)

// A micro-triangle as it is drawn: turned over in mirrored instances.
struct DumpTriangle
{
	uint corners;  // vertices of its item, 10 bits each
	uint payload;  // packPayload
};
SHARED_LAYOUT(DumpTriangle, 8, payload, 4)

// Everything that one workgroup of a rasteriser draws: a full cluster or a batch.
#define DUMP_ITEM_VERTICES RASTER_BATCH_VERTICES
#define DUMP_ITEM_TRIANGLES RASTER_BATCH_TRIANGLES
struct DumpItem
{
	uint vertex_count;
	uint triangle_count;
	DumpVertex vertices[DUMP_ITEM_VERTICES];
	DumpTriangle triangles[DUMP_ITEM_TRIANGLES];
};
SHARED_LAYOUT(DumpItem, 24584, triangles, 18440)

struct DumpMicroArgs
{
	RasterInputs inputs;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(Batch) batches;  // 0 when nothing is tessellated
	GPU_PTR(ShadingData) shading;
	GPU_PTR(DumpItem) items;
	uint item_capacity;
};
SHARED_LAYOUT(DumpMicroArgs, 128, item_capacity, 120)

SHARED_END

#endif
