// What the output surface is as a whole: closed, of the input's shape, with a volume.
#pragma once
#include "verify/micro_set.h"

namespace tessera::verify
{

// Collects counts and sums of all micro-triangles; instances count each for itself.
class Topology
{
public:
	// All micro-triangles of one base triangle.
	void addTriangle(std::span<const MicroTriangle> group);
	// One welded edge of the input, with the points along it (both ends included). `is_loop`: both ends are one vertex.
	void addEdge(bool is_loop, uint64_t points);
	void add(const Topology& other);

	// Compares with the input where that is closed and manifold; else only says what was found.
	void check(const reference::HostScene& scene, CheckResult& result) const;

private:
	int64_t inner_points_ = 0, inner_edges_ = 0, edge_points_ = 0, edge_segments_ = 0, triangles_ = 0, collapsed_ = 0;
	dvec3 vector_area_ = dvec3(0);
	double area_ = 0, volume_ = 0;  // mesh units
};

}  // namespace tessera::verify
