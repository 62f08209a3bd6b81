// What the user may ask of a frame: the values behind the option table of app/options.h.
#pragma once
#include "scene/metric.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tessera
{

// Who finds visibility.
enum class Raster : uint8_t
{
	Auto,
	Soft,     // compute
	Mesh,     // mesh shaders
	Indexed,  // vertices and indices expanded by compute
	Rt,       // rays through pixels' centres
};
inline constexpr std::string_view kRasterNames[] = { "auto", "soft", "mesh", "indexed", "rt" };
inline constexpr std::string_view rasterName(Raster raster)
{
	return kRasterNames[static_cast<uint8_t>(raster)];
}

// What a frame's rays are traced through is built from.
enum class RayPath : uint8_t
{
	Auto,
	Clusters,   // clusters and templates (VK_NV_cluster_acceleration_structure)
	Triangles,  // all micro-triangles at once (VK_KHR_acceleration_structure)
};
inline constexpr std::string_view kRayPathNames[] = { "auto", "clusters", "khr" };

// What a driver is told of a build.
enum class BuildPreference : uint8_t
{
	Default,
	FastBuild,
	FastTrace,
};
inline constexpr std::string_view kBuildPreferenceNames[] = { "default", "fast-build", "fast-trace" };

constexpr uint32_t kLeastClusterVertices = 8192;  // those of CLUSTER_GROUP_SIZE clusters
constexpr uint32_t kMostTruncatedBits = 22;       // of a position's mantissa, which has 23

// Order shared with shaders/shading/shade.h (VIEW_*).
enum class ViewMode : uint8_t
{
	Shaded,
	Clusters,
	Parts,
	Triangles,
	Factors,
	Depth,
	Normals,
	Wireframe,
	Facets,
	Height,
	Instances,
	Materials,
	Primitives,
	Area,
	Error,
};

// Kinds of culling, each can be switched off.
struct CullOptions
{
	bool frustum = true;
	bool backface = true;   // whole clusters by their normal cone; single back faces are never shown in either case
	bool occlusion = true;  // behind what the frame before, or this frame so far, has seen; compute rasteriser only
	bool any() const { return frustum || backface || occlusion; }
};

struct RenderOptions
{
	float rate = 4;  // pixels per segment; 0 = off
	Metric metric = Metric::Edge;
	uint32_t max_split = 8;  // pieces per edge in one split
	Raster raster = Raster::Auto;
	CullOptions cull;
	ViewMode view = ViewMode::Shaded;
	bool wireframe = false;  // sides of micro-triangles and base triangles over the view
	float displacement_scale = 1;
	float displacement_offset = 0;  // mesh units, added to every displacement before it is scaled
	bool smooth_normals = true;     // false: faceted shading
	bool shadows = false;           // of the sun, by rays
	uint32_t ao_samples = 0;        // rays per pixel for ambient occlusion; 0: none
	float ao_radius_world = 0;      // what is farther does not occlude; 0: a tenth of the scene's radius
	float ray_falloff = 4;          // how fast segments grow outside the view where only rays of light meet them; 0: not at all
	bool ray_hidden = true;         // and so, over some frames, on instances that something hides
	RayPath ray_path = RayPath::Auto;
	bool ray_sharing = true;  // untessellated instances of a mesh are traced through one structure of it
	// Where rays' structures are built from clusters:
	bool transient_units = true;   // triangles of factor 1 in mixed clusters are built together, else each as its pattern
	bool transient_groups = true;  // so are triangles of factors up to 2
	BuildPreference transient_build = BuildPreference::Default;
	uint32_t truncated_bits = 0;                // of positions' mantissas; 0 is exact
	uint32_t most_cluster_mib = 1024;           // memory of a frame's clusters
	uint32_t most_cluster_vertices = 1u << 24;  // micro-vertices of a frame
	uint32_t width_px = 1920;
	uint32_t height_px = 1080;
	std::map<std::string, uint32_t> capacities;  // by list name
	uint64_t lists_bytes = 0;                    // memory of all lists together; 0: capacities of their own
	std::vector<std::string> forced;             // passes, shader features and resources that are kept though nothing needs them
};

}  // namespace tessera
