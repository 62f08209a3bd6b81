// What remains of a seam: heights along it are the owner's, so the other side steps from those to its own within its first row of
// micro-triangles.
#pragma once
#include "verify/screen.h"

namespace tessera::verify
{

struct SeamJump
{
	uint64_t points = 0;      // micro-vertices on seams, on the side that does not own them
	double largest_mesh = 0;  // between the owner's height and the triangle's own there, mesh units
	double sum_mesh = 0;
	double largest_px = 0;
	double largest_over_row = 0;  // over the length of the shortest micro-edge that leaves the point: the step's slope
	Place place;                  // of the largest in mesh units

	double meanMesh() const { return points > 0 ? sum_mesh / double(points) : 0; }
	void merge(const SeamJump& other);
};

// `sorted`: all micro-triangles of a frame.
SeamJump measureSeams(const reference::HostScene& scene, const View& view, const Screen& screen, std::span<const MicroTriangle> sorted);

}  // namespace tessera::verify
