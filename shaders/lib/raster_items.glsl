// What the passes that rasterise in compute have in common: which items there are, and what a triangle of one shows.
#ifndef TESSERA_LIB_RASTER_ITEMS
#define TESSERA_LIB_RASTER_ITEMS
#include "lib/features.glsl"
#include "lib/frame_data.glsl"
#include "raster/raster_micro.h"
#include "lib/work_item.glsl"

layout(push_constant, scalar) uniform Args { RasterMicroArgs args; };

bool isTwoSided(WorkItem item, uint triangle)
{
	if (!HAS_MIXED_SIDES)
		return !HAS_SINGLE_SIDED;
	return (args.inputs.material_flags.at[itemMaterial(item, triangle)] & MATERIAL_DOUBLE_SIDED) != 0u;
}

// Items of a phase: full clusters by their own word, batches by range.
struct PhaseItems
{
	uint clusters;     // of all phases
	uint first_batch;
	uint count;
};

PhaseItems phaseItems()
{
	bool second = HAS_OCCLUSION && args.phase == PHASE_SECOND;
	PhaseItems items;
	items.clusters = args.heads.at[LIST_FULL_CLUSTERS].wanted;
	items.first_batch = second ? args.counts.at[0].second_batches : 0u;
	uint batch_end = HAS_TESSELLATION ? (HAS_OCCLUSION && !second ? args.counts.at[0].second_batches : args.heads.at[LIST_BATCHES].wanted) : 0u;
	items.count = items.clusters + batch_end - items.first_batch;
	return items;
}

bool isOfPhase(PhaseItems items, uint index)
{
	return !HAS_OCCLUSION || index >= items.clusters || args.full_clusters.at[index].phase == args.phase;
}

// The number of the index-th item of the phase among full clusters and, after those, batches.
uint itemNumber(PhaseItems items, uint index) { return index < items.clusters ? index : index + items.first_batch; }

#endif
