#include "frame/height_footprints.h"
#include "frame/renderer.h"
#include "shared/lists.h"

#include <algorithm>

namespace tessera
{

SceneSizes sizesOf(const BuiltScene& scene)
{
	SceneSizes sizes;
	sizes.vertices = scene.positions.size();
	sizes.triangles = scene.triangles.size();
	sizes.clusters = scene.clusters.size();
	sizes.meshes = scene.meshes.size();
	sizes.instances = scene.instances.size();
	sizes.materials = scene.materials.size();
	for (const MeshRecord& mesh : scene.meshes)
		sizes.most_groups_per_mesh =
			std::max<uint64_t>(sizes.most_groups_per_mesh, (mesh.cluster_count + CLUSTER_GROUP_SIZE - 1) / CLUSTER_GROUP_SIZE);
	for (const Instance& instance : scene.instances)
		sizes.instanced_clusters += scene.meshes[instance.mesh].cluster_count;
	for (const HeightMapData& map : scene.height_maps)
	{
		sizes.height_texel_bytes += map.texels.size() * sizeof(uint32_t);
		sizes.height_footprint_bytes += footprintBytes(map);
	}
	for (const ColorTexture& texture : scene.color_textures)
		sizes.color_texture_bytes += texture.rgba.size() * 4 / 3;
	sizes.seam_edges = scene.seam_edges.size();
	sizes.seam_corners = scene.seam_corners.size();
	sizes.height_maps = scene.height_maps.size();
	return sizes;
}

DeviceTraits traitsOf(const Device& device)
{
	return { device.gates.mesh_shader, device.gates.buffer_atomics_64, device.gates.fragment_primitive_id, device.is_cpu,
			 device.limits.most_footprint_bytes };
}

}  // namespace tessera
