// Arguments of trace_visibility.
#ifndef TESSERA_RAYTRACING_TRACE_VISIBILITY_H
#define TESSERA_RAYTRACING_TRACE_VISIBILITY_H
#include "shared/raster_inputs.h"
#include "shared/ray_sharing.h"

SHARED_BEGIN

// The payload of a triangle that is met in a shared structure and listed nowhere: culling found that no pixel can see it.
#define LISTED_NOWHERE 0xffffffffu

struct TraceVisibilityArgs
{
	RasterInputs inputs;
	GPU_PTR(uint) payloads;      // expanded_triangles, or those of transient clusters
	uint64_t visibility;         // address of a 64-bit word per pixel: depth << 32 | payload
	GPU_PTR(MeshRecord) meshes;  // this and the next two: with structures that instances share
	GPU_PTR(uint) shared_instances;
	GPU_PTR(uint) shared_clusters;
	uint first_payload;  // where payloads begin
	uint unused;
};
SHARED_LAYOUT(TraceVisibilityArgs, 120, unused, 116)

SHARED_END

#endif
