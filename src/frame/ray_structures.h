// What a frame's rays are traced through: one bottom-level structure of the frame's micro-triangles, and the scene over it. Sizes follow the demand:
// a build on the device takes its count from the host, which knows the last frame's.
#pragma once
#include "frame/stats.h"
#include "gpu/acceleration_structure.h"
#include "gpu/pipeline.h"
#include "plan/plan.h"

#include <optional>

namespace tessera
{

// Triangles that a structure is built of before a frame has shown how many it has, at most.
constexpr uint32_t kFirstTriangles = 64u * 1024;

// Addresses that a build reads, and what they can hold.
struct RayInputs
{
	uint64_t micro_vertices = 0, instances = 0;
	uint64_t expanded_triangles = 0;  // 0: instances are of structures from elsewhere (ray_clusters.h), so that only the scene is built
	uint32_t vertex_capacity = 0, triangle_capacity = 0, instance_count = 0;
};

class RayStructures
{
public:
	explicit RayStructures(Device& device) : device_(device) {}

	// Makes the structures of a frame that is not drawn yet. `inputs` may be elsewhere than before. Writes the scene's descriptor where it is a new
	// one. Errors: BadInput (out of memory).
	Status prepare(const RayInputs& inputs, const PlanInput& input, BindlessSet& bindless);
	// Lets go of everything.
	void drop();

	// Triangles that the frame's structure is built of; those that the frame does not have get no area.
	uint32_t reserved() const { return reserved_; }
	// A round of the frame had this many, if its lists held them (`fits`). True when they are more than reserved: the frame must be drawn again,
	// prepared anew with room for all.
	bool isTooSmallFor(uint32_t wanted, bool fits);

	uint64_t geometryAddress() const { return geometry_.address(); }
	void recordGeometry(VkCommandBuffer commands) const;
	void recordScene(VkCommandBuffer commands) const;

	bool exists() const { return bool(scene_); }
	// `wanted`: triangles of the last frame.
	RayStats stats(uint32_t wanted) const;

private:
	void reserve(const PlanInput& input);
	Status makeGeometry(const PlanInput& input);
	void dropGeometry();
	Status makeScene(BindlessSet& bindless);
	Status makeScratch();

	Device& device_;
	RayInputs inputs_;
	std::optional<StructureBuild> geometry_build_, scene_build_;
	AccelerationStructure geometry_, scene_;
	Buffer scratch_;
	uint32_t reserved_ = 0, peak_ = 0, peak_used_ = 0;
	uint32_t most_wanted_ = 0;  // of all rounds since the last preparation
	bool was_drawn_ = false;    // a round, since then
	TriangleInput triangles_;   // of the last preparation
	bool keeps_places_ = false;
	bool can_refit_ = false;  // the structure holds these very triangles, each in its place
	bool refits_ = false;     // and is only moved to this frame's vertices
};

}  // namespace tessera
