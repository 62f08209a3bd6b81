// Arguments of frame_begin.
#ifndef TESSERA_CULLING_FRAME_BEGIN_H
#define TESSERA_CULLING_FRAME_BEGIN_H
#include "shared/lists.h"

SHARED_BEGIN

struct FrameBeginArgs
{
	GPU_PTR(ListHead) heads;
	GPU_PTR(FrameCounts) counts;
};
SHARED_LAYOUT(FrameBeginArgs, 16, counts, 8)

SHARED_END

#endif
