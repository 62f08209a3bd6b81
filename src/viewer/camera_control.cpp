#include "viewer/camera_control.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace tessera::view
{

namespace
{

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kSteepest = 89.5 * kDegree;  // orbits end here: up and the view must not be parallel

struct Axes
{
	dvec3 right, up, forward;
	double distance = 1;  // eye to target
};

Axes axesOf(const Camera& camera)
{
	Axes axes;
	const dvec3 view = camera.target - camera.eye;
	axes.distance = glm::length(view);
	axes.forward = view / axes.distance;
	axes.right = glm::normalize(glm::cross(axes.forward, camera.up));
	axes.up = glm::cross(axes.right, axes.forward);
	return axes;
}

dvec3 rotated(const dvec3& vector, const dvec3& axis, double angle_rad)
{
	return dvec3(glm::rotate(dmat4(1), angle_rad, axis) * dvec4(vector, 0));
}

// The view direction turned about up and then tilted, no steeper than kSteepest.
dvec3 turnedDirection(const Camera& camera, const dvec3& direction, dvec2 turn_rad)
{
	const dvec3 up = glm::normalize(camera.up);
	const double steepness = std::asin(std::clamp(glm::dot(direction, up), -1.0, 1.0));
	const double most = std::max(kSteepest, std::abs(steepness));
	const double tilt = std::clamp(steepness + turn_rad.y, -most, most) - steepness;
	const dvec3 right = glm::normalize(glm::cross(direction, up));
	return glm::normalize(rotated(rotated(direction, right, tilt), up, -turn_rad.x));
}

double focalPx(const Camera& camera, double height_px)
{
	return height_px / (2 * std::tan(camera.fov_y_rad / 2));
}

// World units per pixel at a depth.
double pixelSize(const Camera& camera, double depth, double height_px)
{
	return camera.orthographic ? camera.height_world / height_px : depth / focalPx(camera, height_px);
}

}  // namespace

Camera orbited(const Camera& camera, dvec2 turn_rad)
{
	Camera moved = camera;
	const Axes axes = axesOf(camera);
	moved.eye = camera.target - turnedDirection(camera, axes.forward, { turn_rad.x, -turn_rad.y }) * axes.distance;
	return moved;
}

Camera turned(const Camera& camera, dvec2 turn_rad)
{
	Camera moved = camera;
	const Axes axes = axesOf(camera);
	moved.target = camera.eye + turnedDirection(camera, axes.forward, turn_rad) * axes.distance;
	return moved;
}

Camera panned(const Camera& camera, dvec2 move_px, uint32_t height_px)
{
	const double size = pixelSize(camera, axesOf(camera).distance, height_px);
	return flown(camera, dvec3(-move_px.x * size, move_px.y * size, 0));
}

Camera dollied(const Camera& camera, double steps)
{
	Camera moved = camera;
	const double factor = std::pow(0.9, steps);
	moved.eye = camera.target + (camera.eye - camera.target) * factor;
	moved.height_world = camera.height_world * factor;
	return moved;
}

Camera flown(const Camera& camera, const dvec3& move)
{
	Camera moved = camera;
	const Axes axes = axesOf(camera);
	const dvec3 step = axes.right * move.x + axes.up * move.y + axes.forward * move.z;
	moved.eye += step;
	moved.target += step;
	return moved;
}

Camera lookingAt(const Camera& camera, const dvec3& point, double distance)
{
	Camera moved = camera;
	const Axes axes = axesOf(camera);
	moved.target = point;
	moved.eye = point - axes.forward * (distance > 0 ? distance : axes.distance);
	return moved;
}

Camera framing(const Camera& camera, const dvec3& centre, double radius, double aspect)
{
	const double slope = std::tan(camera.fov_y_rad / 2) * std::min(1.0, aspect);
	Camera moved = lookingAt(camera, centre, radius / std::sin(std::atan(slope)));
	moved.height_world = 2 * radius / std::min(1.0, aspect);
	return moved;
}

Camera withFov(const Camera& camera, double fov_deg)
{
	Camera moved = camera;
	moved.fov_y_rad = std::clamp(fov_deg, 1.0, 150.0) * kDegree;
	moved.orthographic = false;
	return moved;
}

dvec3 pointAt(const Camera& camera, dvec2 pixel, uvec2 size_px, double depth_world)
{
	const Axes axes = axesOf(camera);
	const double size = pixelSize(camera, depth_world, size_px.y);
	const dvec2 from_middle = pixel - dvec2(size_px) / 2.0;
	return camera.eye + axes.forward * depth_world + axes.right * (from_middle.x * size) - axes.up * (from_middle.y * size);
}

dvec3 pixelOf(const Camera& camera, const dvec3& point, uvec2 size_px)
{
	const Axes axes = axesOf(camera);
	const dvec3 relative = point - camera.eye;
	const double depth = glm::dot(relative, axes.forward);
	const double size = pixelSize(camera, depth, size_px.y);
	return { size_px.x / 2.0 + glm::dot(relative, axes.right) / size, size_px.y / 2.0 - glm::dot(relative, axes.up) / size, depth };
}

}  // namespace tessera::view
