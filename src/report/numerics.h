// What the floats of a tessellated surface are worth: finite, equal on both sides of every edge, near the double evaluation.
#pragma once
#include "report/micro_mesh.h"

namespace tessera::report
{

struct Numerics
{
	uint64_t vertices = 0;
	uint64_t not_finite = 0;           // vertices with a component that is not
	double worst_base_ulp = 0;         // undisplaced position, in units in the last place of the triangle's largest coordinate
	double worst_displaced_ulp = 0;    // displaced position, in those of the larger of that and its own largest coordinate
	double worst_share_of_bound = 0;   // largest error over the bound that double_surface derives for it
	uint64_t shared_edges = 0;         // base edges with two or more triangles
	uint64_t differing_edges = 0;      // whose sides differ in number, place or position of a vertex
	uint64_t edge_points = 0;          // compared along them
	uint64_t zero_area_triangles = 0;  // micro-triangles without area, or of positions that are not finite
	std::string first_problem;         // of the edges; empty when there is none
};

// Compares at most `most_vertices` vertices with double precision (evenly chosen), all of them otherwise. On all threads.
Numerics measureNumerics(const reference::HostScene& scene, const View& view, const MicroScene& micro, uint64_t most_vertices = 2'000'000);

}  // namespace tessera::report
