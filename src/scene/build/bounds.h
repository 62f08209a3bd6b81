// Bounds of everything that a displaced cluster or mesh can reach. Source: DESIGN.md, contract C3; shared/bounds.h uses them.
#pragma once
#include "scene/scene.h"

namespace tessera
{

// Fills in cluster_bounds, mesh_bounds, mesh_longest_edge, world_low and world_high from everything else in `scene`.
//
// Reach: per triangle, the heights that its texture footprint and those of its seam edges and corners can give on any mip; 0 where
// nothing is displaced. Directions: per triangle, what normalised interpolation of its vertices' directions can give.
// An offset that a frame adds to every displacement is not known here: directions are those of all triangles that read heights, of 0 too.
// PN triangles: the box holds the control points of every patch; `bulge` is the length of the longest of what they add to the flat triangle's.
// Normal cone, of flat undisplaced clusters of single-sided materials: all of the cluster faces away from an eye with
//   dot(cone_axis, centre - eye) >= cone_cutoff * |centre - eye| + radius
// for any sphere (centre, radius) around the cluster, in mesh units; cone_cutoff is 2 where that never holds.
// Runs on all threads.
void buildBounds(BuiltScene& scene);

// The bounds without any displacement and without a cone, to be grown: empty box, no reach.
DisplacedBounds emptyBounds();

}  // namespace tessera
