// The scene as every later stage uses it: welded, cut into clusters, bounded; arrays laid out as the GPU reads them.
#pragma once
#include "scene/imported_scene.h"
#include "shared/bounds.h"
#include "shared/geometry.h"

#include <limits>

namespace tessera
{

// A height map ready for evaluation: mips box-filtered, texels packed as shared/geometry.h says.
struct HeightMapData
{
	HeightMap record;              // texels = 0 here: the address is filled in by whoever holds the texels
	std::vector<uint32_t> texels;  // all levels, packed words
	std::string name;
};

// Colour side of a material.
struct MaterialData
{
	std::string name;
	vec4 base_color = { 1, 1, 1, 1 };
	uint32_t base_color_texture = NO_INDEX;  // into BuiltScene::color_textures
	float metallic = 1;
	float roughness = 1;
	vec3 emissive = { 0, 0, 0 };
	bool double_sided = false;
	uint32_t height_map = NO_INDEX;  // into BuiltScene::height_maps
};

// A colour texture: 8-bit RGBA, sRGB, level 0.
struct ColorTexture
{
	std::string name;
	uint32_t width = 0, height = 0;
	std::vector<uint8_t> rgba;
	Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;
	bool nearest = false;
};

// Counts and facts of the derivation: what `info`, the plan (C5) and the warnings tell.
struct SceneTraits
{
	uint64_t base_triangles = 0;        // over all meshes, once each
	uint64_t instanced_triangles = 0;   // over all instances
	uint32_t degenerate_triangles = 0;  // zero-area base triangles, kept
	uint32_t seam_edges = 0;            // triangle edges whose heights another triangle owns
	uint32_t seam_corners = 0;
	uint32_t zero_directions = 0;    // welded vertices without a direction
	uint32_t nonmanifold_edges = 0;  // welded edges with more than two triangles
	uint32_t boundary_edges = 0;
	bool has_displacement = false;  // some material displaces by something other than 0
	bool has_height_u8 = false;     // formats of the height maps
	bool has_height_u16 = false;
	bool has_height_f32 = false;
	bool has_wrap_repeat = false;  // wrap modes of the height maps
	bool has_wrap_clamp = false;
	bool has_wrap_mirror = false;
	bool has_color_textures = false;
	bool has_vertex_colors = false;
	bool has_single_sided = false;
	bool has_double_sided = false;
	bool has_mirrored_instances = false;
	bool directions_are_normals = false;  // every direction equals the authored normal bit for bit
	bool has_pn = false;                  // base triangles are PN triangles, and some are curved
};

// Arrays that the scene does not need are empty (C5): uvs, densities without displacement, directions without it and PN triangles, color_uvs
// without colour textures, seam arrays without seams.
struct BuiltScene
{
	std::string path;
	// per vertex, all meshes one after another
	std::vector<vec3> positions;
	std::vector<vec3> directions;  // of the welded fan, for displacement and PN triangles; unit or zero
	std::vector<vec3> normals;     // shading normal, unit: authored or computed
	std::vector<vec2> uvs;         // for the height map
	std::vector<float> densities;  // height texels per mesh unit
	std::vector<vec2> color_uvs;
	std::vector<uint32_t> colors;    // RGBA8, linear
	std::vector<uint32_t> weld_ids;  // welded vertex; unique over the whole scene. Host only: verification and tests
	std::vector<uint32_t> seam_corner_indices;
	// per triangle
	std::vector<uint32_t> triangles;  // packBaseTriangle
	std::vector<uint32_t> first_seam_edges;
	std::vector<uint32_t> source_triangles;        // index of the triangle in its mesh's input order. Host only
	std::vector<TriangleDetail> triangle_details;  // metric `detail` (build/edge_detail.h), empty unless asked for
	std::vector<vec3> edge_roughness;              // of the triangle's three edges: metric `displaced`, empty unless asked for
	float most_roughness = 0;
	// seams
	std::vector<SeamEdge> seam_edges;
	std::vector<SeamCorner> seam_corners;
	// clusters and meshes
	std::vector<ClusterRecord> clusters;
	std::vector<DisplacedBounds> cluster_bounds;
	std::vector<TriangleReach> triangle_reaches;  // per triangle; empty when nothing is displaced
	std::vector<MeshRecord> meshes;
	std::vector<DisplacedBounds> mesh_bounds;
	std::vector<float> mesh_longest_edge;  // mesh units; bounds how often a triangle can be split
	std::vector<Instance> instances;
	// materials
	std::vector<MaterialData> materials;
	std::vector<uint32_t> material_height_maps;  // parallel to materials
	std::vector<HeightMapData> height_maps;
	std::vector<ColorTexture> color_textures;
	std::vector<FileCamera> cameras;
	// world-space bounds of everything displaced, at displacement scale 1
	dvec3 world_low = dvec3(0), world_high = dvec3(0);
	SceneTraits traits;
	std::vector<std::string> warnings;
};

}  // namespace tessera
