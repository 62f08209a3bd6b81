#include "frame/ray_structures.h"

#include "plan/conditions.h"

#include <algorithm>
#include <utility>

namespace tessera
{

namespace
{

constexpr uint32_t kStepTriangles = 1024;  // structures hold a multiple of it
constexpr uint32_t kVertexBytes = 16;

uint32_t roundedUp(uint64_t triangles)
{
	return static_cast<uint32_t>(std::max<uint64_t>(1, (triangles + kStepTriangles - 1) / kStepTriangles) * kStepTriangles);
}

}  // namespace

Status RayStructures::prepare(const RayInputs& inputs, const PlanInput& input, BindlessSet& bindless)
{
	inputs_ = inputs;
	if (inputs.expanded_triangles != 0)
	{
		reserve(input);
		reserved_ = std::min(reserved_, inputs.triangle_capacity);
		TRY(makeGeometry(input));
	}
	else
		dropGeometry();
	TRY(makeScene(bindless));
	return makeScratch();
}

Status RayStructures::makeGeometry(const PlanInput& input)
{
	TriangleInput triangles;
	triangles.vertices = inputs_.micro_vertices;
	triangles.vertex_stride_bytes = kVertexBytes;
	triangles.most_vertex = inputs_.vertex_capacity;  // that of triangles that are not there
	triangles.indices = inputs_.expanded_triangles;
	triangles.triangle_count = reserved_;
	triangles.opaque = !(input.scene.has_single_sided && input.scene.has_double_sided);
	const bool keeps_places = kKeepsPlaces.holds(input);
	// An update takes the same counts and flags, and the same indices, which clusters that keep their places give.
	const bool is_same = geometry_ && keeps_places == keeps_places_ && triangles.triangle_count == triangles_.triangle_count &&
						 triangles.most_vertex == triangles_.most_vertex;
	refits_ = is_same && keeps_places && can_refit_;
	can_refit_ = false;
	keeps_places_ = keeps_places;
	triangles_ = triangles;
	geometry_build_.emplace(triangles, BuildFlags{ false, keeps_places });
	if (is_same)
		return {};
	peak_ = peak_used_ = 0;  // since it was made
	geometry_ = {};
	TRY_ASSIGN(geometry_,
			   AccelerationStructure::create(device_, geometry_build_->type(), geometry_build_->sizes(device_).structure_bytes, "ray_geometry"));
	return {};
}

Status RayStructures::makeScene(BindlessSet& bindless)
{
	const uint32_t before = scene_build_ ? scene_build_->count() : 0;
	scene_build_.emplace(InstanceInput{ inputs_.instances, inputs_.instance_count }, BuildFlags{});
	if (scene_ && before == inputs_.instance_count)
		return {};
	scene_ = {};
	TRY_ASSIGN(scene_, AccelerationStructure::create(device_, scene_build_->type(), scene_build_->sizes(device_).structure_bytes, "ray_scene"));
	bindless.writeStructure(scene_.handle());
	return {};
}

// One for both builds, which a barrier parts.
Status RayStructures::makeScratch()
{
	const StructureBuild::Sizes geometry = geometry_build_ ? geometry_build_->sizes(device_) : StructureBuild::Sizes(),
								scene = scene_build_->sizes(device_);
	const uint64_t bytes =
		scratchBytes(device_, std::max({ geometry.build_scratch_bytes, geometry.update_scratch_bytes, scene.build_scratch_bytes }));
	if (scratch_ && scratch_.bytes() >= bytes && scratch_.bytes() <= 2 * bytes)
		return {};
	scratch_ = {};
	TRY_ASSIGN(scratch_, Buffer::create(device_, bytes, MemoryKind::Device, "ray_scratch"));
	return {};
}

void RayStructures::dropGeometry()
{
	geometry_build_.reset();
	geometry_ = {};
	can_refit_ = refits_ = false;
	reserved_ = 0;
}

void RayStructures::drop()
{
	dropGeometry();
	scene_build_.reset();
	scene_ = {};
	scratch_ = {};
}

void RayStructures::reserve(const PlanInput& input)
{
	const uint32_t wanted = std::exchange(most_wanted_, 0);
	const bool was_drawn = std::exchange(was_drawn_, false);
	// Then the frame has every triangle of the scene.
	if (kKeepsPlaces.holds(input))
	{
		reserved_ = static_cast<uint32_t>(std::clamp<uint64_t>(input.scene.instanced_triangles, 1, device_.limits.most_structure_triangles));
		return;
	}
	if (reserved_ == 0)
		reserved_ = roundedUp(
			std::min<uint64_t>(kMakesStructures.holds(input) ? input.view.own_triangles : input.scene.instanced_triangles, kFirstTriangles));
	// Nearly full: a moving camera seldom draws a frame twice. Half empty: what is not there costs a little, too.
	const bool is_small = uint64_t(wanted) * 16 > uint64_t(reserved_) * 15, is_large = wanted < reserved_ / 2;
	// With shared structures a frame may have no triangles of its own.
	if ((wanted > 0 || (was_drawn && kSharesStructures.holds(input))) && (is_small || is_large))
		reserved_ = static_cast<uint32_t>(std::min<uint64_t>(roundedUp(uint64_t(wanted) * 9 / 8), device_.limits.most_structure_triangles));
}

bool RayStructures::isTooSmallFor(uint32_t wanted, bool fits)
{
	most_wanted_ = std::max(most_wanted_, wanted);
	was_drawn_ = true;
	peak_ = std::max(peak_, wanted);
	if (wanted > reserved_)
		return true;
	can_refit_ = keeps_places_ && fits;
	if (fits)
		peak_used_ = std::max(peak_used_, wanted);
	return false;
}

void RayStructures::recordGeometry(VkCommandBuffer commands) const
{
	geometry_build_->record(device_, commands, geometry_.handle(), scratchAddress(device_, scratch_), refits_ ? BuildMode::Update : BuildMode::Build);
}

void RayStructures::recordScene(VkCommandBuffer commands) const
{
	scene_build_->record(device_, commands, scene_.handle(), scratchAddress(device_, scratch_), BuildMode::Build);
}

RayStats RayStructures::stats(uint32_t wanted) const
{
	if (!exists())
		return {};
	RayStats stats;
	stats.traced = true;
	stats.scene_bytes = scene_.bytes();
	stats.scratch_bytes = scratch_.bytes();
	if (!geometry_build_)
		return stats;
	stats.refitted = refits_;
	stats.triangles = { "ray_geometry", wanted, geometry_build_->count(), peak_, peak_used_, geometry_.bytes() };
	const auto bytes_for = [&](uint32_t count) {
		return geometry_build_->sizes(device_, std::max(count, 1u)).structure_bytes;
	};
	stats.geometry_bytes = geometry_.bytes();
	stats.geometry_used_bytes = bytes_for(std::min(wanted, geometry_build_->count()));
	return stats;
}

}  // namespace tessera
