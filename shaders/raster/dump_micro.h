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

// Everything that one workgroup of a rasteriser draws: a full cluster or a batch. Its ranges of the vertices and triangles, which no other item has.
#define DUMP_ITEM_VERTICES RASTER_BATCH_VERTICES
#define DUMP_ITEM_TRIANGLES RASTER_BATCH_TRIANGLES
struct DumpItem
{
	uint first_vertex;
	uint vertex_count;
	uint first_triangle;
	uint triangle_count;
};
SHARED_LAYOUT(DumpItem, 16, triangle_count, 12)

// Where a dump goes: the beginning of its buffer. What exceeds a capacity is counted and left out.
struct DumpHead
{
	GPU_PTR(DumpItem) items;
	GPU_PTR(DumpVertex) vertices;
	GPU_PTR(DumpTriangle) triangles;
	uint item_capacity;
	uint vertex_capacity;
	uint triangle_capacity;
	uint unused;
};
SHARED_LAYOUT(DumpHead, 40, unused, 36)

struct DumpMicroArgs
{
	RasterInputs inputs;
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(FullCluster) full_clusters;
	GPU_PTR(Batch) batches;  // 0 when nothing is tessellated
	GPU_PTR(ShadingData) shading;
	GPU_PTR(DumpHead) dump;
};
SHARED_LAYOUT(DumpMicroArgs, 120, dump, 112)

SHARED_END

#endif
