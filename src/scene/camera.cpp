#include "scene/camera.h"

#include <algorithm>
#include <glm/gtc/matrix_inverse.hpp>
#include <limits>

namespace tessera
{

namespace
{

struct Basis
{
	dvec3 right, up, forward;
};

Result<Basis> basisOf(const Camera& camera)
{
	const dvec3 forward = camera.target - camera.eye;
	const double length = glm::length(forward);
	if (!(length > 0) || !std::isfinite(length))
		return badInput("camera: eye and target must be finite and differ");
	const dvec3 right = glm::cross(forward / length, camera.up);
	const double right_length = glm::length(right);
	if (!(right_length > 1e-9 * glm::length(camera.up)) || !std::isfinite(right_length))
		return badInput("camera: up must be finite, not zero and not along the view");
	Basis basis = { right / right_length, {}, forward / length };
	basis.up = glm::cross(basis.right, basis.forward);
	return basis;
}

double focalPx(const Camera& camera, uint32_t height_px)
{
	return camera.orthographic ? height_px / camera.height_world : height_px / (2 * std::tan(camera.fov_y_rad / 2));
}

// Distance from the eye to the farthest corner of the scene.
double farDistance(const Camera& camera, const BuiltScene& scene)
{
	const dvec3 reach = glm::max(glm::abs(scene.world_low - camera.eye), glm::abs(scene.world_high - camera.eye));
	return glm::length(reach);
}

vec3 highPart(dvec3 value)
{
	return vec3(value);
}
vec3 lowPart(dvec3 value)
{
	return vec3(value - dvec3(vec3(value)));
}

void setProjection(View& view, const Camera& camera, const BuiltScene& scene, const ViewRequest& request, double unit)
{
	const double aspect = double(request.width_px) / request.height_px;
	const double near = nearDistance(camera, scene) * unit;
	view.near = static_cast<float>(near);
	if (!camera.orthographic)
	{
		const double focal = 1 / std::tan(camera.fov_y_rad / 2);
		view.focal_y = static_cast<float>(focal);
		view.focal_x = static_cast<float>(focal / aspect);
		view.depth_slope = 0;
		view.depth_offset = view.near;
		view.w_slope = 1;
		view.w_offset = 0;
		view.distance_weight = 1;
		view.distance_floor_squared = view.near * view.near;
		return;
	}
	const double far = std::max(farDistance(camera, scene) * unit * 1.01, near * 2);
	view.focal_y = static_cast<float>(2 / (camera.height_world * unit));
	view.focal_x = static_cast<float>(2 / (camera.height_world * unit * aspect));
	view.depth_slope = static_cast<float>(-1 / (far - near));
	view.depth_offset = static_cast<float>(far / (far - near));
	view.w_slope = 0;
	view.w_offset = 1;
	view.distance_weight = 0;
	view.distance_floor_squared = static_cast<float>(unit * unit);
}

Status checkCamera(const Camera& camera, const ViewRequest& request)
{
	constexpr double kDegree = 3.14159265358979323846 / 180;
	if (!camera.orthographic && !(camera.fov_y_rad >= 0.01 * kDegree && camera.fov_y_rad <= 179 * kDegree))
		return badInput("camera: the field of view must lie between 0.01 and 179 degrees");
	if (camera.orthographic && !(camera.height_world > 0 && std::isfinite(camera.height_world)))
		return badInput("camera: the height of an orthographic view must be above 0");
	if (!(request.rate_px >= 0) || !std::isfinite(request.rate_px))
		return badInput("camera: the rate must be 0 or more pixels");
	return {};
}

}  // namespace

double boundingRadius(const BuiltScene& scene)
{
	return std::max(glm::length(scene.world_high - scene.world_low) / 2, 1e-30);
}

double nearDistance(const Camera& camera, const BuiltScene& scene)
{
	return camera.near_world > 0 ? camera.near_world : std::max(boundingRadius(scene) / 1000, 1e-6);
}

Camera framingCamera(const BuiltScene& scene)
{
	Camera camera;
	camera.target = (scene.world_low + scene.world_high) / 2.0;
	const dvec3 backward = glm::normalize(dvec3(0.55, 0.4, 1.0));
	const dvec3 right = glm::normalize(glm::cross(camera.up, backward));
	const dvec3 up = glm::cross(backward, right);
	// The nearest eye that sees every corner of the bounds within a square view, with a margin.
	const double slope = std::tan(camera.fov_y_rad / 2) * 0.93;
	const dvec3 half = (scene.world_high - scene.world_low) / 2.0;
	double distance = boundingRadius(scene) * 1e-3;
	for (int corner = 0; corner < 8; ++corner)
	{
		const dvec3 p = half * dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
		const double across = std::max(std::abs(glm::dot(p, right)), std::abs(glm::dot(p, up)));
		distance = std::max(distance, across / slope + glm::dot(p, backward));
	}
	camera.eye = camera.target + backward * distance;
	return camera;
}

Camera cameraOf(const FileCamera& file_camera, const BuiltScene& scene)
{
	Camera camera;
	camera.eye = dvec3(file_camera.world[3]);
	camera.target = camera.eye + glm::normalize(-dvec3(file_camera.world[2])) * std::max(boundingRadius(scene), 1e-6);
	camera.up = glm::normalize(dvec3(file_camera.world[1]));
	camera.fov_y_rad = file_camera.fov_y_rad;
	camera.near_world = file_camera.near_world;
	camera.orthographic = file_camera.orthographic;
	camera.height_world = file_camera.height_world;
	return camera;
}

float rateOverFocalSquared(const Camera& camera, uint32_t height_px, double rate_px)
{
	if (rate_px <= 0)
		return std::numeric_limits<float>::infinity();
	const double s = rate_px / focalPx(camera, height_px);
	return static_cast<float>(s * s);
}

void setRate(View& view, const Camera& camera, const ViewRequest& request)
{
	view.rate_over_focal_squared = rateOverFocalSquared(camera, request.height_px, request.every_factor_one ? 0 : request.rate_px);
	// Segments longer than two thirds of their distance: factors above 1 could not be split to an end (factor_rule.h).
	if (!camera.orthographic && view.rate_over_focal_squared > 4.0f / 9)
		view.rate_over_focal_squared = std::numeric_limits<float>::infinity();
	view.sample_over_focal_squared = request.rate_px > 0 ? rateOverFocalSquared(camera, request.height_px, request.rate_px) : 0;
}

// What follows from the rest of a view.
static void setDerived(View& view, const Basis& basis)
{
	view.width_subpixels = static_cast<float>(view.width_px) * SCREEN_SUBPIXELS;
	view.height_subpixels = static_cast<float>(view.height_px) * SCREEN_SUBPIXELS;
	const dvec3 right = basis.right / double(view.focal_x), up = basis.up / double(view.focal_y);
	view.ray_first = vec3(up - right);
	view.ray_x = vec3(right * (2.0 / view.width_px));
	view.ray_y = vec3(up * (-2.0 / view.height_px));
}

// Rounding of a point's distance from a side of the view, in scaled units, where the farthest distance of the scene is 1 to 2.
constexpr double kSideRounding = 1e-5;

// The view's sides, for edges out of it (shared/edge_factor.h).
static void setSides(View& view, const Camera& camera, const ViewRequest& request, const Basis& basis)
{
	if (request.ray_falloff <= 0)
		return;
	const double focal_x = double(view.focal_x), focal_y = double(view.focal_y);
	// Perspective: sides meet in the eye, |x| focal = ahead. Orthographic: they are parallel, |x| = 1 / focal.
	const double norm_x = camera.orthographic ? 1 : std::hypot(focal_x, 1), norm_y = camera.orthographic ? 1 : std::hypot(focal_y, 1);
	view.side_x = vec3(basis.right * (camera.orthographic ? 1 : focal_x / norm_x));
	view.side_y = vec3(basis.up * (camera.orthographic ? 1 : focal_y / norm_y));
	view.ahead = vec3(basis.forward);
	view.side_x_ahead = camera.orthographic ? 0 : static_cast<float>(1 / norm_x);
	view.side_y_ahead = camera.orthographic ? 0 : static_cast<float>(1 / norm_y);
	view.side_x_from = static_cast<float>(kSideRounding + (camera.orthographic ? 1 / focal_x : 0));
	view.side_y_from = static_cast<float>(kSideRounding + (camera.orthographic ? 1 / focal_y : 0));
	view.behind_from = static_cast<float>(kSideRounding);
	// Where all is equally far, what is out of view is measured by half the view's height.
	const double growth = double(request.ray_falloff) * (camera.orthographic ? 2 / camera.height_world : 1);
	view.unseen_growth = static_cast<float>(growth * growth);
}

Result<View> makeView(const Camera& camera, const BuiltScene& scene, const ViewRequest& request)
{
	TRY(checkCamera(camera, request));
	TRY_ASSIGN(const Basis basis, basisOf(camera));
	// The power of two that brings the largest distance that can occur near 1.
	const double reach = std::max({ farDistance(camera, scene), nearDistance(camera, scene), 1e-30 });
	const double unit = std::exp2(-std::floor(std::log2(reach)));

	View view = {};
	view.eye_high = highPart(camera.eye);
	view.eye_low = lowPart(camera.eye);
	view.right = vec3(basis.right);
	view.up = vec3(basis.up);
	view.forward = vec3(basis.forward);
	view.unit = static_cast<float>(unit);
	view.inverse_unit_squared = static_cast<float>(1 / (unit * unit));
	setProjection(view, camera, scene, request, unit);
	setRate(view, camera, request);
	view.displacement_scale = request.displacement_scale;
	view.displacement_offset = request.displacement_offset;
	view.width_px = request.width_px;
	view.height_px = request.height_px;
	setDerived(view, basis);
	setSides(view, camera, request, basis);
	return view;
}

Result<View> drawnFrom(const View& tessellated, const Camera& tessellated_for, const Camera& camera, const BuiltScene& scene,
					   const ViewRequest& request)
{
	TRY(checkCamera(camera, request));
	TRY_ASSIGN(const Basis basis, basisOf(camera));
	View view = tessellated;
	setProjection(view, camera, scene, request, double(tessellated.unit));
	view.near = tessellated.near;
	view.distance_weight = tessellated.distance_weight;
	view.distance_floor_squared = tessellated.distance_floor_squared;
	view.right = vec3(basis.right);
	view.up = vec3(basis.up);
	view.forward = vec3(basis.forward);
	// From the eye that points are relative to, to the one that sees them.
	const dvec3 back = (tessellated_for.eye - camera.eye) * double(tessellated.unit);
	view.draw_eye = vec3(-back);
	view.draw_offset = vec3(dvec3(glm::dot(back, basis.right), glm::dot(back, basis.up), glm::dot(back, basis.forward)));
	setDerived(view, basis);
	return view;
}

double inverseScaleSquared(const Instance& instance)
{
	const dmat3 axes(instance.world);
	const double scale_squared = (glm::dot(axes[0], axes[0]) + glm::dot(axes[1], axes[1]) + glm::dot(axes[2], axes[2])) / 3;
	return scale_squared > 1e-60 ? std::min(1 / scale_squared, 1e30) : 0;
}

namespace
{

// Most that the instance's matrix stretches a length, at most a little more where its axes are not at right angles: the norm of the matrix times
// the transposed one.
double mostStretch(const Instance& instance)
{
	const dmat3 axes(instance.world);
	double squared = 0;
	for (int i = 0; i < 3; ++i)
		squared =
			std::max(squared, std::abs(glm::dot(axes[i], axes[0])) + std::abs(glm::dot(axes[i], axes[1])) + std::abs(glm::dot(axes[i], axes[2])));
	return std::sqrt(squared);
}

// InstanceRecord::reach, rounded up.
vec3 reachOf(const Instance& instance, const DisplacedBounds& bounds)
{
	const bool has_directions = bounds.direction_low != vec3(0) || bounds.direction_high != vec3(0);
	const double stretch = mostStretch(instance) * 1.0001;
	const double height = std::max(std::abs(double(bounds.reach_low)), std::abs(double(bounds.reach_high)));
	return vec3(dvec3(double(bounds.longest_edge) + double(bounds.bulge), height, has_directions ? 1 : 0) * stretch);
}

}  // namespace

InstanceRecord placementRecord(const Instance& instance)
{
	const dmat4& world = instance.world;
	const dvec3 translation = dvec3(world[3]);
	InstanceRecord record = {};
	record.row0 = vec3(world[0].x, world[1].x, world[2].x);
	record.row1 = vec3(world[0].y, world[1].y, world[2].y);
	record.row2 = vec3(world[0].z, world[1].z, world[2].z);
	record.translation_high = highPart(translation);
	record.translation_low = lowPart(translation);
	return record;
}

InstanceRecord instanceRecord(const Instance& instance, const DisplacedBounds& bounds)
{
	InstanceRecord record = placementRecord(instance);
	record.inverse_scale_squared = static_cast<float>(inverseScaleSquared(instance));
	record.mesh = instance.mesh;
	record.mirrored = glm::determinant(dmat3(instance.world)) < 0 ? 1 : 0;
	record.reach = reachOf(instance, bounds);
	return record;
}

namespace
{

// Distance from the eye to a world box of everything an instance can reach.
double distanceToInstance(const Camera& camera, const BuiltScene& scene, const Instance& instance)
{
	const DisplacedBounds& bounds = scene.mesh_bounds[instance.mesh];
	const dvec3 low = bounds.low, high = bounds.high;
	const dvec3 centre = dvec3(instance.world * dvec4((low + high) / 2.0, 1));
	const dvec3 half = (high - low) / 2.0;
	dvec3 reach(0);
	for (int axis = 0; axis < 3; ++axis)
		reach += glm::abs(dvec3(instance.world[axis])) * half[axis];
	return glm::length(glm::max(glm::abs(camera.eye - centre) - reach, dvec3(0)));
}

// Most that the instance's matrix stretches a length.
double largestScale(const Instance& instance)
{
	double squared = 0;
	for (int axis = 0; axis < 3; ++axis)
		squared += glm::dot(dvec3(instance.world[axis]), dvec3(instance.world[axis]));
	return std::sqrt(squared);
}

}  // namespace

FactorBound boundFactors(const Camera& camera, const BuiltScene& scene, const ViewRequest& request, uint32_t table_size, uint32_t max_split)
{
	FactorBound bound;
	bound.largest_factor = 0;
	if (request.rate_px > 0 && !request.every_factor_one)
	{
		const double near = nearDistance(camera, scene);
		const double s = request.rate_px / focalPx(camera, request.height_px);
		for (const Instance& instance : scene.instances)
		{
			const double distance = camera.orthographic ? 1 : std::max(near, distanceToInstance(camera, scene, instance));
			bound.largest_factor = std::max(bound.largest_factor, scene.mesh_longest_edge[instance.mesh] * largestScale(instance) / (s * distance));
		}
		if (request.metric == Metric::Displaced)
		{
			// As tableScaleSquared of shared/edge_detail.h.
			const double scale_squared = double(request.displacement_scale) * double(request.displacement_scale);
			bound.largest_factor *=
				std::sqrt(1 + double(scene.most_roughness) * (scene.traits.has_pn ? std::max(scale_squared, 1.0) : scale_squared));
		}
		bound.largest_factor *= 1.001;  // covers float rounding on the device
	}
	bound.above_one = bound.largest_factor >= 1.5;
	if (bound.largest_factor >= table_size + 0.5)
	{
		const double levels = std::ceil(std::log(bound.largest_factor / table_size) / std::log(double(max_split)));
		bound.split_levels = static_cast<uint32_t>(std::clamp(levels + 1, 2.0, 30.0));
	}
	return bound;
}

}  // namespace tessera
