// What the usual way of displacing would make of the same micro-triangles: how many cracks the rules of this program are worth.
#pragma once
#include "frame/stats.h"
#include "verify/micro_set.h"

namespace tessera::verify
{

struct UsualWay
{
	uint64_t points = 0;        // compared along shared edges
	uint64_t own_sides = 0;     // points that differ when every triangle displaces by its own normals and texture coordinates
	double own_sides_gap = 0;   // largest gap of those, mesh units
	uint64_t barycentrics = 0;  // and when positions also come from float barycentrics, P2 + (P0 - P2) u + (P1 - P2) v
	double barycentrics_gap = 0;
	// Part and split triangles that did not fit their lists at the wanted rate, in the frame that wanted most: what clamping to the lists
	// would leave out. A lower bound where lists were cut short one after the other.
	uint64_t lost = 0;

	void merge(const UsualWay& other);
};

// `sorted`: all micro-triangles of a frame without culling. Domain points, and so counts along edges, stay those of this program.
UsualWay measureUsualWay(const reference::HostScene& scene, const View& view, std::span<const MicroTriangle> sorted);

// Triangles that a frame's lists did not hold when it was first listed.
uint64_t lostTheUsualWay(const FrameResult& result);

}  // namespace tessera::verify
