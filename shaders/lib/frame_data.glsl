// What every workgroup of a frame reads alike, included before shared/height.h: uniform buffers, so that devices with constant memory serve it from there.
#ifndef TESSERA_LIB_FRAME_DATA
#define TESSERA_LIB_FRAME_DATA
#include "shared/geometry.h"
#include "shared/history.h"
#include "shared/view.h"

layout(set = 0, binding = 3, scalar) uniform FrameView { View frame_view; };
layout(set = 0, binding = 4, scalar) uniform FrameSurface { Surface frame_surface; };
layout(set = 0, binding = 5, scalar) uniform FrameHeightMaps { HeightMap frame_height_maps[UNIFORM_HEIGHT_MAPS]; };
layout(set = 0, binding = 6, scalar) uniform FrameHistoryBlock { FrameHistory frame_history; };

#endif
