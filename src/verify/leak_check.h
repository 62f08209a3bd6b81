// C1 in the picture: does the background shine through where the surface has no hole?
#pragma once
#include "verify/picture.h"
#include "verify/screen.h"

namespace tessera::verify
{

// Which pixels lie wholly within what the micro-triangles of a frame cover: their centres and points around them up to 1/16 pixel away, found in
// double precision with one edge function for both sides of every edge, so that no point can fall between two neighbours. Rasterisers may
// move a vertex by 1/256 pixel. Triangles that cross the near plane count as nothing.
class Silhouette
{
public:
	// `set`: every micro-triangle of the frame.
	Silhouette(const Screen& screen, std::span<const MicroTriangle> set);

	// Background pixels of a picture of the same frame that lie within: each is a leak.
	CheckResult leaks(const VisiblePicture& picture) const;

private:
	uint32_t width_;
	std::vector<bool> within_;
};

}  // namespace tessera::verify
