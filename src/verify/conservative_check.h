// C3: nothing that is culled could have touched a pixel.
#pragma once
#include "verify/picture.h"
#include "verify/screen.h"

namespace tessera::verify
{

// What a frame draws, by identity: clusters drawn as stored, and part triangles.
struct DrawnThings
{
	std::vector<std::array<uint32_t, 2>> full_clusters;  // instance, cluster; sorted
	std::vector<Identity> parts;                         // with micro-triangle 0; sorted

	bool has(const MicroTriangle& t) const;
};
void addDrawn(const FrameDump& lists, const SceneOrder& order, DrawnThings& drawn);
void sortDrawn(DrawnThings& drawn);

// `all`, `uncut`: every micro-triangle and the picture of the frame without culling; `drawn`, `culled`: of the frame with culling at the
// same granted rate. Violations: pixels that see something else (comparePictures), and micro-triangles that culling left out although
// they cover a pixel's centre (by 1/64 pixel, in double precision) and are seen there or nearer than what is.
CheckResult checkConservative(const Screen& screen, std::span<const MicroTriangle> all, const VisiblePicture& uncut, const DrawnThings& drawn,
							  const VisiblePicture& culled);

}  // namespace tessera::verify
