// Micro-triangles on the screen, in double precision: what the rasterisers are held against.
#pragma once
#include "verify/micro_set.h"

namespace tessera::verify
{

// A point of the picture: pixels from its upper left corner, and reversed depth (nearer is larger).
struct ScreenPoint
{
	double x, y, depth;
};

class Screen
{
public:
	// Kept by reference: both must outlive this object.
	Screen(const reference::HostScene& scene, const View& view);

	// True when the picture can show this side of the micro-triangle: its front, or any of a double-sided material. The points in the
	// order of the base triangle's winding.
	bool shows(const MicroTriangle& t, const std::array<ScreenPoint, 3>& points) const;

	// The corners, when all lie before the near plane.
	bool project(const MicroTriangle& t, std::array<ScreenPoint, 3>& points) const;

	// What lies before the near plane, as a polygon of up to 4 corners; empty when nothing does.
	std::vector<ScreenPoint> clipped(const MicroTriangle& t) const;

	// Pixels per world unit at a displaced point of an instance.
	double pixelsPerUnit(uint32_t instance, vec3 displaced) const;

	uint32_t width() const { return view_.width_px; }
	uint32_t height() const { return view_.height_px; }

private:
	dvec4 clipOf(uint32_t instance, vec3 displaced) const;
	ScreenPoint onScreen(const dvec4& clip) const;

	const reference::HostScene& scene_;
	const View& view_;
	dvec3 eye_;
};

// Pixels whose boxes a triangle's box touches: [first, end) in x and y, within the picture.
struct PixelBox
{
	uint32_t x0, x1, y0, y1;
};
PixelBox pixelBox(const std::array<ScreenPoint, 3>& p, uint32_t width_px, uint32_t height_px);

// Doubled area; below 0 for triangles that run counter-clockwise as seen (y points down).
double screenArea(const std::array<ScreenPoint, 3>& p);

}  // namespace tessera::verify
