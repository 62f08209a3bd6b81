#include "frame/height_footprints.h"
#include "frame/ray_structures.h"
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
	sizes.world_radius = boundingRadius(scene);
	return sizes;
}

SceneSizes sizesOf(const BuiltScene& scene, const TessellationTable& table)
{
	SceneSizes sizes = sizesOf(scene);
	sizes.patterns = table.configs.size();
	sizes.table_vertices = table.vertices.size();
	sizes.table_triangles = table.triangles.size();
	return sizes;
}

DeviceTraits traitsOf(const Device& device)
{
	DeviceTraits traits = { device.gates.mesh_shader,           device.gates.buffer_atomics_64,  device.gates.fragment_primitive_id, device.is_cpu,
							device.limits.most_footprint_bytes, device.limits.most_small_rate_px };
	traits.rays = device.gates.rays();
	traits.most_structure_triangles = device.limits.most_structure_triangles;
	traits.most_structure_instances = device.limits.most_structure_instances;
	traits.clusters = device.gates.cluster_acceleration_structure;
	traits.why_no_clusters = device.gates.why_no_clusters;
	if (!traits.rays)
		return traits;
	TriangleInput triangles;
	triangles.vertex_stride_bytes = 16;
	triangles.most_vertex = 2 * kFirstTriangles;
	triangles.triangle_count = kFirstTriangles;
	const StructureBuild::Sizes geometry = StructureBuild(triangles, {}).sizes(device),
								scene = StructureBuild(InstanceInput{ 0, 1 }, {}).sizes(device);
	traits.structure_triangle_bytes = double(geometry.structure_bytes) / kFirstTriangles;
	traits.structure_scratch_bytes = double(geometry.build_scratch_bytes) / kFirstTriangles;
	traits.structure_instance_bytes = double(scene.structure_bytes);
	return traits;
}

}  // namespace tessera
