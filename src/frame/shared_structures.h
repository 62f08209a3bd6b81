// Structures of meshes in their own space, each made once, which rays go through for all instances of the mesh that are not tessellated and far
// enough away (shared/ray_sharing.h). Displaced meshes are among them where nothing is tessellated at all: heights then are those of the finest mip
// from everywhere, so that their vertices depend on nothing but the displacement options.
#pragma once
#include "frame/stats.h"
#include "gpu/acceleration_structure.h"
#include "gpu/commands.h"
#include "plan/plan.h"
#include "scene/ray_sharing.h"

#include <memory>
#include <optional>

namespace tessera
{

// Per mesh: 1 when one of its instances may share in this view. Empty where none can, whatever the view.
std::vector<uint8_t> meshesThatShare(const BuiltScene& scene, const View& view, const PlanInput& input);

// A mesh that is made in this frame, in what expand_meshes writes: numbers to add, modulo 2^32, to those of the scene's vertices and triangles.
struct ExpandedMesh
{
	uint32_t mesh = 0;
	uint32_t first_cluster = 0, cluster_count = 0;
	uint32_t vertex_place = 0, triangle_place = 0;
};

class SharedStructures
{
public:
	SharedStructures(Device& device, const BuiltScene& scene) : device_(device), scene_(scene) {}
	~SharedStructures();
	SharedStructures(const SharedStructures&) = delete;
	SharedStructures& operator=(const SharedStructures&) = delete;

	// Says of the frame that is planned next whether any instance shares, and whether structures are to be made for that.
	void look(const View& view, PlanInput& input);
	// Makes room for what look() found missing; makes what the last frames built as small as it can be. Nothing of it may be in use.
	// Errors: BadInput (out of memory).
	Status prepare(const FramePlan& plan, const PlanInput& input, CommandRecorder& commands);
	// The frame that built them is finished: what they were built from goes.
	Status endFrame();
	void drop();

	uint64_t addresses() const { return addresses_.address(); }  // of one 64-bit device address per mesh; 0: it has no structure
	std::span<const ExpandedMesh> expanded() const { return expanded_; }
	uint64_t vertices() const { return vertices_.address(); }  // float x, y, z
	uint64_t indices() const { return indices_.address(); }
	void recordBuilds(VkCommandBuffer commands) const;

	// `instances`: that shared in the last frame.
	void addStats(RayStats& stats, uint32_t instances) const;
	uint64_t bytes() const;

private:
	// Of one mesh; without a structure it is not made.
	struct MeshStructure
	{
		AccelerationStructure structure;
		bool is_displaced = false;  // by these options
		float displacement_scale = 0, displacement_offset = 0;
		bool is_built = false, is_compact = false;
		uint64_t compact_bytes = 0;
	};
	struct Build
	{
		StructureBuild build;
		uint32_t mesh = 0;
		uint64_t scratch_offset = 0;
		bool begins_batch = false;  // the scratch memory is used again from here on
	};

	bool isCurrent(uint32_t mesh, const PlanInput& input) const;
	Status makeInputs();
	Status makeStructures(const PlanInput& input);
	Status compact(CommandRecorder& commands);
	Status uploadAddresses(CommandRecorder& commands);
	bool isOpaque(uint32_t mesh) const;

	Device& device_;
	const BuiltScene& scene_;
	std::vector<uint8_t> undisplaced_;       // per mesh
	std::vector<MeshStructure> structures_;  // per mesh
	std::vector<uint64_t> uploaded_;         // addresses as they are on the device
	std::vector<uint32_t> missing_;          // of the frame that is planned
	std::vector<ExpandedMesh> expanded_;
	std::vector<Build> builds_;
	Buffer addresses_, vertices_, indices_, scratch_;
	VkQueryPool sizes_ = VK_NULL_HANDLE;  // compacted, one per build
};

}  // namespace tessera
