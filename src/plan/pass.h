// What a pass declares, and what the planner knows about scene, options, device and view. No Vulkan.
#pragma once
#include "plan/render_options.h"
#include "scene/scene.h"

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

namespace tessera
{

class PassContext;  // frame/pass_context.h: what a pass records with

enum class Access : uint8_t
{
	ComputeRead,
	ComputeWrite,  // also appends: reads and writes
	Indirect,      // indirect arguments
	MeshRead,      // mesh shader
	VertexRead,    // vertex shader
	IndexRead,
	FragmentRead,
	Color,       // colour attachment
	Depth,       // depth attachment
	BuildRead,   // what an acceleration structure is built from: vertices, indices, instances, other structures
	BuildWrite,  // the structure itself, and its scratch memory
	RayRead,     // shaders of a ray tracing pipeline; what rays are traced through
	RayWrite,
	CopyRead,
	CopyWrite,
};

bool writes(Access access);

struct SceneSizes
{
	uint64_t vertices = 0, triangles = 0, clusters = 0, meshes = 0, instances = 0, materials = 0;
	uint64_t most_groups_per_mesh = 0;  // groups of CLUSTER_GROUP_SIZE clusters
	uint64_t instanced_clusters = 0;    // clusters over all instances
	uint64_t height_texel_bytes = 0, height_footprint_bytes = 0, color_texture_bytes = 0, seam_edges = 0, seam_corners = 0, height_maps = 0;
	double world_radius = 0;                                         // of the displaced bounds
	uint64_t patterns = 0, table_vertices = 0, table_triangles = 0;  // of the tessellation table
};

// What the planner needs of the device: the gates that decide passes.
struct DeviceTraits
{
	bool mesh_shader = false;
	bool buffer_atomics_64 = false;
	bool fragment_primitive_id = false;
	bool is_cpu = false;
	uint64_t most_footprint_bytes = 0;  // memory that height maps may take to be read faster
	float most_small_rate_px = 0;       // up to this rate small triangles have a kernel of their own
	bool rays = false;                  // acceleration structures and ray tracing pipelines
	// What the driver asks for, about: for structures per triangle and per instance, and for scratch memory per triangle.
	uint64_t most_structure_triangles = 0, most_structure_instances = 0;
	double structure_triangle_bytes = 0, structure_instance_bytes = 0, structure_scratch_bytes = 0;
	// Those structures can be built from clusters and templates, or why not.
	bool clusters = false;
	std::string_view why_no_clusters = "the device lacks VK_NV_cluster_acceleration_structure";
};

// What the host knows of the view before it is drawn.
struct ViewTraits
{
	bool factors_above_one = true;   // false: no edge of the scene can reach factor 2 from here
	uint32_t split_levels = 0;       // most levels of triangle_split that can occur; 0: no factor above the table
	double rate_px = 0;              // granted rate
	bool looks_for_hidden = true;    // false: the last frames hid too little to pay for the passes that look for it
	bool is_seen_elsewhere = false;  // from another camera than it is culled for: then nothing is looked for
	bool shares_structures = false;  // some instance's rays can go through a structure of its mesh (scene/ray_sharing.h)
	bool makes_structures = false;   // such a structure is not made yet
	uint64_t own_triangles = 0;      // then: base triangles of instances that do not share
	uint32_t rounds = 1;             // a frame in more than one round draws its clusters in turns (C2)
};

struct PlanInput;

// Something that must hold for a pass, a use or a shader feature to be kept, and what is said when it does not.
struct Condition
{
	bool (*is_met)(const PlanInput& input);
	std::string_view reason_if_not;
	// --force: whether it may hold although nothing needs it, the picture staying as it is (nullptr: never), and what is said when it may not.
	bool (*can_be_forced)(const PlanInput& input) = nullptr;
	std::string_view why_not_forced = "options decide it, not the scene";

	bool isForceable(const PlanInput& input) const { return can_be_forced && can_be_forced(input); }
	bool holds(const PlanInput& input) const;  // met, or forced where it can be
};

// What is kept though nothing needs it (plan/forced.h).
struct Forced
{
	std::vector<const Condition*> conditions;
	std::vector<std::string_view> outputs;  // of passes that nothing else reads

	bool empty() const { return conditions.empty() && outputs.empty(); }
};

struct PlanInput
{
	RenderOptions options;
	SceneTraits scene;
	SceneSizes sizes;
	DeviceTraits device;
	ViewTraits view;
	Forced forced;

	bool forces(const Condition& condition) const
	{
		return std::find(forced.conditions.begin(), forced.conditions.end(), &condition) != forced.conditions.end();
	}
};

inline bool Condition::holds(const PlanInput& input) const
{
	return is_met(input) || (input.forces(*this) && isForceable(input));
}

struct Use
{
	std::string_view resource;
	Access access = Access::ComputeRead;
	const Condition* when = nullptr;  // nullptr: always
};

struct PassDesc
{
	std::string_view name;  // timer label, report key, file stem
	std::span<const Use> uses;
	std::span<const Condition* const> needed;  // all must hold, else the pass is dropped with the reason
	// SPIR-V files below shaders/: one compute shader, the stages of a draw, or those of a ray tracing pipeline, ray generation first; none where
	// the pass records commands alone.
	std::span<const std::string_view> shaders;
	uint32_t (*repeats)(const PlanInput& input);  // nullptr: once
	void (*record)(PassContext& pass);
};

// A shader feature: a specialisation constant that compiles code out.
struct Feature
{
	std::string_view name;  // constant's name in the shaders
	uint32_t constant_id = 0;
	bool on = false;
	std::string_view reason;               // why it is off, or would be were it not forced
	const Condition* condition = nullptr;  // that it is on under
	bool forced = false;                   // on by --force alone
};

// A buffer or image that passes use: how large it is when kept.
struct ResourceDesc
{
	std::string_view name;
	std::string_view kind;  // attribute, buffer, list, texture, image, structure
	uint64_t (*bytes)(const PlanInput& input);
};

}  // namespace tessera
