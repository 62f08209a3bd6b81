// Arguments of rate_fit.
#ifndef TESSERA_TESSELLATION_RATE_FIT_H
#define TESSERA_TESSELLATION_RATE_FIT_H
#include "shared/lists.h"

SHARED_BEGIN

// Arguments of vkCmdDrawIndexedIndirect (Vulkan specification, VkDrawIndexedIndirectCommand).
struct IndexedDraw
{
	uint index_count;
	uint instance_count;
	uint first_index;
	int vertex_offset;
	uint first_instance;
};
SHARED_LAYOUT(IndexedDraw, 20, first_instance, 16)

struct RateFitArgs
{
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
	GPU_PTR(IndexedDraw) indexed_draw;  // 0 unless micro-triangles are expanded
	uint split_levels;                  // levels that triangle_split took apart
};
SHARED_LAYOUT(RateFitArgs, 32, split_levels, 24)

SHARED_END

#endif
