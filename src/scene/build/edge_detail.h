// Tables of the metrics that look at the displaced surface along and beside edges: shared/edge_detail.h reads them.
#pragma once
#include "scene/scene.h"

namespace tessera
{

// How far the displaced surface lies from uniform tessellations of itself: fills in triangle_details from everything else in `scene`; leaves it empty
// when nothing is displaced.
//
// The surface is sampled over every base triangle, at most two thirds of a texel apart, at the finest mip and displacement scale 1; where that takes
// more than 8 million samples in all, those that lie closest lie farther apart. The largest distance from the planes of the micro-triangles of 1, 2,
// 4 .. 128 segments per edge makes the triangle's curve; an edge has the largest of all triangles that meet there. Deviations are displacement alone,
// so they scale with it. Linear in height texels used; on all threads.
void buildEdgeDetails(BuiltScene& scene);

// (Displaced length / length)^2 - 1 of every base edge, 0 to 15, along 16 chords at the finest mip: fills in edge_roughness, the same from all sides
// of an edge; leaves it empty when nothing is displaced. On all threads.
void buildEdgeRoughness(BuiltScene& scene);

}  // namespace tessera
