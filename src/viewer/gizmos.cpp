#include "viewer/gizmos.h"

#include "viewer/camera_control.h"

#include <imgui.h>

#include <algorithm>
#include <set>
#include <utility>

namespace tessera::view
{

namespace
{

constexpr ImU32 kFrustum = IM_COL32(255, 220, 90, 230), kKept = IM_COL32(110, 220, 130, 160), kCulled = IM_COL32(235, 80, 70, 130),
				kCone = IM_COL32(110, 170, 255, 200);
constexpr size_t kMostBoxes = 5000;  // more are not told apart, and take too long

// Pairs of the corners 0..7 whose numbers differ in one bit: the edges of a box.
constexpr std::pair<int, int> kBoxEdges[] = { { 0, 1 }, { 2, 3 }, { 4, 5 }, { 6, 7 }, { 0, 2 }, { 1, 3 },
											  { 4, 6 }, { 5, 7 }, { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } };

class LineDrawing
{
public:
	explicit LineDrawing(const Session& session) : camera_(session.shown.drawn_from), size_(session.viewport_size)
	{
		const ImGuiIO& io = ImGui::GetIO();
		scale_ = { io.DisplayFramebufferScale.x, io.DisplayFramebufferScale.y };
		low_ = dvec2(session.viewport_low);
		near_ = nearDistance(camera_, session.scene->subject.scene);
		const ImVec2 low = place({ 0, 0 }), high = place(dvec2(size_));
		list_.PushClipRect(low, high, true);
	}
	~LineDrawing() { list_.PopClipRect(); }
	LineDrawing(const LineDrawing&) = delete;
	LineDrawing& operator=(const LineDrawing&) = delete;

	void line(const dvec3& from, const dvec3& to, ImU32 color, float width = 1)
	{
		if (const auto seen = pixelLine(camera_, from, to, near_, size_))
			list_.AddLine(place(seen->from), place(seen->to), color, width);
	}
	void box(const std::array<dvec3, 8>& corners, ImU32 color, float width = 1)
	{
		for (const auto& [a, b] : kBoxEdges)
			line(corners[static_cast<size_t>(a)], corners[static_cast<size_t>(b)], color, width);
	}

private:
	ImVec2 place(const dvec2& pixel) const
	{
		const dvec2 at = (pixel + low_) / scale_;
		return { static_cast<float>(at.x), static_cast<float>(at.y) };
	}

	ImDrawList& list_ = *ImGui::GetBackgroundDrawList();
	Camera camera_;
	uvec2 size_;
	dvec2 scale_ = dvec2(1), low_ = dvec2(0);
	double near_ = 0;
};

std::array<dvec3, 8> placedCorners(const Box& box, const Instance& instance)
{
	std::array<dvec3, 8> corners;
	for (size_t i = 0; i < corners.size(); ++i)
	{
		const dvec3 corner = { double(i & 1 ? box.high.x : box.low.x), double(i & 2 ? box.high.y : box.low.y),
							   double(i & 4 ? box.high.z : box.low.z) };
		corners[i] = dvec3(instance.world * dvec4(corner, 1));
	}
	return corners;
}

void drawCone(LineDrawing& drawing, const DisplacedBounds& bounds, const Instance& instance)
{
	if (bounds.cone_cutoff > 1)
		return;
	const dvec3 middle = dvec3(bounds.low + bounds.high) / 2.0;
	const double length = glm::length(dvec3(bounds.high) - middle);
	const auto world = [&](const dvec3& p) {
		return dvec3(instance.world * dvec4(p, 1));
	};
	// The cutoff is the sine of the cone's half angle around the axis.
	const dvec3 axis = dvec3(bounds.cone_axis);
	const double sine = std::clamp(double(bounds.cone_cutoff), 0.0, 1.0), cosine = std::sqrt(1 - sine * sine);
	const dvec3 side = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0))), other = glm::cross(axis, side);
	drawing.line(world(middle), world(middle + axis * length), kCone, 2);
	for (const dvec3& across : { side, -side, other, -other })
		drawing.line(world(middle), world(middle + (axis * cosine + across * sine) * length), kCone);
}

using VisibleClusters = std::set<std::pair<uint32_t, uint32_t>>;

void drawInstance(LineDrawing& drawing, const Session& session, uint32_t index, const VisibleClusters& visible, size_t& boxes)
{
	const BuiltScene& scene = session.scene->subject.scene;
	const Gizmos& wanted = session.gizmos;
	const Instance& instance = scene.instances[index];
	const MeshRecord& mesh = scene.meshes[instance.mesh];
	const float scale = session.shown.options.displacement_scale, offset = session.shown.options.displacement_offset;
	const auto first = visible.lower_bound({ index, 0 });
	const bool instance_kept = first != visible.end() && first->first == index;
	const auto shows = [&](bool kept) {
		return kept ? wanted.kept : wanted.culled;
	};
	if (wanted.instances && shows(instance_kept) && boxes < kMostBoxes)
	{
		++boxes;
		drawing.box(placedCorners(displacedBox(scene.mesh_bounds[instance.mesh], scale, offset), instance), instance_kept ? kKept : kCulled, 2);
	}
	if (!wanted.clusters && !wanted.cones)
		return;
	for (uint32_t c = mesh.first_cluster; c < mesh.first_cluster + mesh.cluster_count && boxes < kMostBoxes; ++c)
	{
		const bool kept = visible.count({ index, c }) > 0;
		if (!shows(kept))
			continue;
		++boxes;
		if (wanted.clusters)
			drawing.box(placedCorners(displacedBox(scene.cluster_bounds[c], scale, offset), instance), kept ? kKept : kCulled);
		if (wanted.cones)
			drawCone(drawing, scene.cluster_bounds[c], instance);
	}
}

}  // namespace

std::optional<PixelLine> pixelLine(const Camera& camera, const dvec3& from, const dvec3& to, double near_world, uvec2 size_px)
{
	const dvec3 forward = glm::normalize(camera.target - camera.eye);
	dvec3 a = from, b = to;
	const double depth_a = glm::dot(a - camera.eye, forward), depth_b = glm::dot(b - camera.eye, forward);
	if (depth_a < near_world && depth_b < near_world)
		return {};
	if (depth_a < near_world)
		a = glm::mix(a, b, (near_world - depth_a) / (depth_b - depth_a));
	if (depth_b < near_world)
		b = glm::mix(b, a, (near_world - depth_b) / (depth_a - depth_b));
	return PixelLine{ dvec2(pixelOf(camera, a, size_px)), dvec2(pixelOf(camera, b, size_px)) };
}

std::array<dvec3, 8> frustumCorners(const Camera& camera, double near_world, double far_world, double aspect)
{
	std::array<dvec3, 8> corners;
	// A picture of 1 line: pixels are heights of the view.
	for (size_t i = 0; i < corners.size(); ++i)
	{
		const double depth = i & 4 ? far_world : near_world;
		const dvec2 pixel = { 0.5 + (i & 1 ? 0.5 : -0.5) * aspect, i & 2 ? 0 : 1 };
		corners[i] = pointAt(camera, pixel, { 1, 1 }, depth);
	}
	return corners;
}

void drawGizmos(const Session& session)
{
	if (!session.scene || session.shown.number == 0)
		return;
	const BuiltScene& scene = session.scene->subject.scene;
	LineDrawing drawing(session);
	if (session.debug_camera)
	{
		const double far = glm::length(session.culled_camera.target - session.culled_camera.eye) + boundingRadius(scene);
		const double near = std::max(nearDistance(session.culled_camera, scene), far * 0.01);
		drawing.box(frustumCorners(session.culled_camera, near, far, double(session.viewport_size.x) / session.viewport_size.y), kFrustum, 2);
	}
	if (!session.gizmos.any())
		return;
	VisibleClusters visible;
	for (const ClusterRef& ref : session.shown.visible)
		visible.insert({ ref.instance, ref.cluster });
	size_t boxes = 0;
	for (uint32_t i = 0; i < scene.instances.size() && boxes < kMostBoxes; ++i)
		drawInstance(drawing, session, i, visible, boxes);
}

}  // namespace tessera::view
