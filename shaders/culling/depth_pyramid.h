// Arguments of depth_pyramid.
#ifndef TESSERA_CULLING_DEPTH_PYRAMID_H
#define TESSERA_CULLING_DEPTH_PYRAMID_H
#include "shared/history.h"

SHARED_BEGIN

struct DepthPyramidArgs
{
	uint64_t visibility;  // address of a 64-bit word per pixel: depth << 32 | payload
};
SHARED_LAYOUT(DepthPyramidArgs, 8, visibility, 0)

SHARED_END

#endif
