// Cameras, and the View that shaders and the CPU reference see: computed in double, rounded once.
#pragma once
#include "base/result.h"
#include "scene/metric.h"
#include "scene/scene.h"

#include <optional>

namespace tessera
{

struct Camera
{
	dvec3 eye = { 0, 0, 3 };  // world units
	dvec3 target = { 0, 0, 0 };
	dvec3 up = { 0, 1, 0 };  // any length, not along the view
	double fov_y_rad = 1.0471975512;
	double near_world = 0;  // 0: bounding radius / 1000, at least 1e-6
	bool orthographic = false;
	double height_world = 2;  // orthographic: height of the view

	bool operator==(const Camera&) const = default;
};

// What a camera is combined with to give a View.
struct ViewRequest
{
	uint32_t width_px = 1920, height_px = 1080;
	double rate_px = 4;             // granted rate, pixels per segment; 0: every factor is 1
	bool every_factor_one = false;  // the coarsest a frame can be (C2)
	float displacement_scale = 1;
	float displacement_offset = 0;  // mesh units, before the scale
	Metric metric = Metric::Edge;
	float ray_falloff = 0;  // how fast segments grow outside the view; 0: not at all
};

// A camera that shows the whole scene.
Camera framingCamera(const BuiltScene& scene);
Camera cameraOf(const FileCamera& file_camera, const BuiltScene& scene);

// Radius of the scene's displaced bounds, at least 1e-30.
double boundingRadius(const BuiltScene& scene);
double nearDistance(const Camera& camera, const BuiltScene& scene);

// Errors: BadInput when eye, target and up do not span a view, or a value is not finite or out of range.
Result<View> makeView(const Camera& camera, const BuiltScene& scene, const ViewRequest& request);

// The view in which a frame that was culled and tessellated for `tessellated` is drawn from another camera: what decides the surface's shape stays,
// what decides where its points lie in the picture is the camera's. Drawn from the same camera it is the same view, bit for bit. Errors: those of
// makeView.
Result<View> drawnFrom(const View& tessellated, const Camera& tessellated_for, const Camera& camera, const BuiltScene& scene,
					   const ViewRequest& request);

// Sets what of the view depends on the rate: s^2 for factors and for mip levels. `view` is otherwise that of the camera and the request.
void setRate(View& view, const Camera& camera, const ViewRequest& request);

// s^2 = (rate / focal_px)^2 of the metric `edge` in float; +infinity for rate 0.
float rateOverFocalSquared(const Camera& camera, uint32_t height_px, double rate_px);

// 1 / (world units per mesh unit)^2, the mean over the axes, as mip levels are found with; 0 for an instance without extent.
double inverseScaleSquared(const Instance& instance);

// An instance's matrix as shaders place by it; all else of the record is 0.
InstanceRecord placementRecord(const Instance& instance);

// `bounds`: of the instance's mesh.
InstanceRecord instanceRecord(const Instance& instance, const DisplacedBounds& bounds);

// What the host can say of factors before the frame: an upper bound over all instances, for the metric of the request.
struct FactorBound
{
	double largest_factor = 1;  // no edge's length / (s * distance) exceeds this
	bool above_one = true;
	uint32_t split_levels = 0;  // levels that triangle_split is expected to need, with one to spare
};
FactorBound boundFactors(const Camera& camera, const BuiltScene& scene, const ViewRequest& request, uint32_t table_size, uint32_t max_split);

}  // namespace tessera
