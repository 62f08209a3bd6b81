// history.h: what a frame knows of the one before it, for occlusion culling.
#ifndef TESSERA_SHARED_HISTORY_H
#define TESSERA_SHARED_HISTORY_H
#include "shared/view.h"

SHARED_BEGIN

// A depth pyramid: per square of PYRAMID_TEXEL_PX pixels the farthest depth seen in it, then PYRAMID_LEVELS - 1 levels of
// half the width and height (rounded up), one after another. Sides of level 0: picture / PYRAMID_TEXEL_PX, rounded up.
#define PYRAMID_TEXEL_PX 4u
#define PYRAMID_LEVELS 5u

struct FrameHistory
{
	GPU_PTR(float) last_pyramid;  // of the frame before
	GPU_PTR(float) pyramid;       // of this one, once its first phase is rasterised
	uint has_last;                // 0: there was no frame before, or of another size
	View last_view;
};
SHARED_LAYOUT(FrameHistory, 280, last_view, 20)

SHARED_FN uint pyramidSide(uint side_px, uint level)
{
	uint texels = (side_px + PYRAMID_TEXEL_PX - 1u) / PYRAMID_TEXEL_PX;
	return (texels + (1u << level) - 1u) >> level;
}

// First texel of a level; of level PYRAMID_LEVELS: how many texels there are.
SHARED_FN uint pyramidFirst(uint width_px, uint height_px, uint level)
{
	uint first = 0u;
	for (uint i = 0u; i < level; ++i)
		first += pyramidSide(width_px, i) * pyramidSide(height_px, i);
	return first;
}

SHARED_END

#endif
