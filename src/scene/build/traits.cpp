#include "scene/build/traits.h"

#include <fmt/format.h>

#include <cstring>

namespace tessera
{

void findTraits(BuiltScene& scene)
{
	SceneTraits& traits = scene.traits;
	traits.base_triangles = scene.triangles.size();
	std::vector<uint64_t> mesh_triangles;
	for (const MeshRecord& mesh : scene.meshes)
	{
		uint64_t& count = mesh_triangles.emplace_back(0);
		for (uint32_t i = mesh.first_cluster; i < mesh.first_cluster + mesh.cluster_count; ++i)
			count += clusterTriangles(scene.clusters[i]);
	}
	for (const Instance& instance : scene.instances)
	{
		traits.instanced_triangles += mesh_triangles[instance.mesh];
		traits.has_mirrored_instances = traits.has_mirrored_instances || glm::determinant(dmat3(instance.world)) < 0;
	}
	for (const ClusterRecord& cluster : scene.clusters)
	{
		const bool double_sided = scene.materials[cluster.material].double_sided;
		traits.has_double_sided = traits.has_double_sided || double_sided;
		traits.has_single_sided = traits.has_single_sided || !double_sided;
	}
	traits.has_displacement = !scene.height_maps.empty();
	for (const HeightMapData& map : scene.height_maps)
	{
		traits.has_height_u8 |= map.record.format == HEIGHT_U8;
		traits.has_height_u16 |= map.record.format == HEIGHT_U16;
		traits.has_height_f32 |= map.record.format == HEIGHT_F32;
		for (const uint32_t wrap : { map.record.wrap_u, map.record.wrap_v })
		{
			traits.has_wrap_repeat |= wrap == WRAP_REPEAT;
			traits.has_wrap_clamp |= wrap == WRAP_CLAMP;
			traits.has_wrap_mirror |= wrap == WRAP_MIRROR;
		}
	}
	traits.has_color_textures = !scene.color_textures.empty();
	traits.has_vertex_colors = !scene.colors.empty();
	const size_t bytes = scene.normals.size() * sizeof(vec3);
	traits.directions_are_normals = !scene.directions.empty() && std::memcmp(scene.directions.data(), scene.normals.data(), bytes) == 0;
	if (traits.zero_directions > 0 && !scene.directions.empty())
		scene.warnings.push_back(fmt::format("{}: {} vertices have normals that cancel out: {}", scene.path, traits.zero_directions,
											 traits.has_displacement ? "they are not displaced" : "PN triangles are flat there"));
}

}  // namespace tessera
