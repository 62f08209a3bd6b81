// Lines over the picture: the second camera's frustum, displaced boxes and normal cones of instances and clusters, culled ones and kept ones.
#pragma once
#include "viewer/session.h"

namespace tessera::view
{

// Draws what session.gizmos asks for over the picture, clipped to it. What is kept is what the device listed as visible in the shown frame.
void drawGizmos(const Session& session);

// A line between two world points in pixels of the picture, cut at the camera's near distance. Nothing when it lies behind.
struct PixelLine
{
	dvec2 from, to;
};
std::optional<PixelLine> pixelLine(const Camera& camera, const dvec3& from, const dvec3& to, double near_world, uvec2 size_px);

// Corners of what a camera sees, near and far: left and right of the lower side, then of the upper; at `far_world` along the view.
std::array<dvec3, 8> frustumCorners(const Camera& camera, double near_world, double far_world, double aspect);

}  // namespace tessera::view
