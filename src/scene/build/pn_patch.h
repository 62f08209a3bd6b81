// PN triangles of a built scene by their control points: what bounds and the plan need to know of them. The surface itself: shared/pn.h.
#pragma once
#include "scene/scene.h"

#include <array>

namespace tessera
{

// What the ten control points of a base triangle's patch add to those of the flat triangle, in mesh units: of the corners nothing; the two of
// each edge, from each end; the middle. The surface adds a weighted mean of these and of 0.
struct PnPatch
{
	std::array<dvec3, 7> bulges;   // edge points near corner 0 towards 1 and 2, near 1 towards 2 and 0, near 2 towards 0 and 1; middle
	std::array<dvec3, 10> points;  // of the patch: corners, then as above
};

// Positions and directions of the corners; directions unit or zero.
PnPatch pnPatch(const std::array<vec3, 3>& positions, const std::array<vec3, 3>& directions);

// That of triangle `index_in_cluster`; the scene has directions.
PnPatch pnPatch(const BuiltScene& scene, const ClusterRecord& cluster, uint32_t index_in_cluster);

// Some patch of the scene is not flat. False where there are no directions.
bool anyCurved(const BuiltScene& scene);

}  // namespace tessera
