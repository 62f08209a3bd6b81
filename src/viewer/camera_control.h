// What the mouse and keys do to a camera. Pure; every function gives a camera that spans a view when it is given one.
#pragma once
#include "scene/camera.h"

namespace tessera::view
{

// Around the target, radians: positive x to the right, positive y upwards. Stops short of straight up and down.
Camera orbited(const Camera& camera, dvec2 turn_rad);

// Turns the view about the eye; the target keeps its distance.
Camera turned(const Camera& camera, dvec2 turn_rad);

// Moves eye and target within the picture's plane, so that the target's depth moves with the mouse by `move_px` (right, down).
Camera panned(const Camera& camera, dvec2 move_px, uint32_t height_px);

// Brings the eye nearer to the target by steps of a tenth; negative: away.
Camera dollied(const Camera& camera, double steps);

// Moves eye and target by (right, up, forward), world units.
Camera flown(const Camera& camera, const dvec3& move);

// The same direction and distance, on another point; or nearer when `distance` > 0.
Camera lookingAt(const Camera& camera, const dvec3& point, double distance = 0);

// The same direction, as near as a sphere of this radius around the point fills the picture.
Camera framing(const Camera& camera, const dvec3& centre, double radius, double aspect);

// Another vertical field of view, 1 to 150 degrees; perspective from then on.
Camera withFov(const Camera& camera, double fov_deg);

// World position of a point in the picture at this depth along the view: pixel centres are at .5.
dvec3 pointAt(const Camera& camera, dvec2 pixel, uvec2 size_px, double depth_world);

// Where a world point lies in the picture (x, y in pixels) and how far before the eye (z, world units along the view).
dvec3 pixelOf(const Camera& camera, const dvec3& point, uvec2 size_px);

}  // namespace tessera::view
