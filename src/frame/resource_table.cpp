// Names, kinds and sizes of all resources (what --print-plan says of them).
#include "frame/frame_resources.h"
#include "plan/conditions.h"
#include "raster/dump_micro.h"
#include "raytracing/place_instances.h"
#include "shading/material_record.h"
#include "shared/hidden.h"
#include "shared/history.h"

#include <algorithm>

namespace tessera
{

namespace
{

template <uint32_t bytes>
uint64_t perVertex(const PlanInput& input)
{
	return input.sizes.vertices * bytes;
}
template <uint32_t bytes>
uint64_t perTriangle(const PlanInput& input)
{
	return input.sizes.triangles * bytes;
}
template <uint32_t bytes>
uint64_t perCluster(const PlanInput& input)
{
	return input.sizes.clusters * bytes;
}
template <uint32_t bytes>
uint64_t perMesh(const PlanInput& input)
{
	return input.sizes.meshes * bytes;
}
template <uint32_t bytes>
uint64_t perInstance(const PlanInput& input)
{
	return input.sizes.instances * bytes;
}
template <uint32_t bytes>
uint64_t perMaterial(const PlanInput& input)
{
	return input.sizes.materials * bytes;
}
template <uint32_t bytes>
uint64_t perPixel(const PlanInput& input)
{
	return uint64_t(input.options.width_px) * input.options.height_px * bytes;
}
template <auto count, uint32_t bytes>
uint64_t ofTable(const PlanInput& input)
{
	return input.sizes.*count * bytes;
}
template <uint64_t bytes>
uint64_t fixedBytes(const PlanInput&)
{
	return bytes;
}

template <uint32_t list>
uint64_t ofList(const PlanInput& input)
{
	const auto capacities = listCapacities(input);
	for (const ListDesc& desc : listDescs())
		if (desc.index == list && capacities)
			return listBytes(desc, (*capacities)[list]);
	return 0;
}

// Of what rays are traced through, before a frame has shown how many triangles it has.
template <auto bytes_per_triangle>
uint64_t ofTriangles(const PlanInput& input)
{
	return static_cast<uint64_t>(double(std::min<uint64_t>(input.scene.instanced_triangles, kFirstTriangles)) * (input.device.*bytes_per_triangle));
}

// Of the clusters that such a frame has, 32 triangles each.
template <uint64_t bytes>
uint64_t ofFirstClusters(const PlanInput& input)
{
	return std::min<uint64_t>(input.scene.instanced_triangles, kFirstTriangles) / 32 * bytes;
}

constexpr ResourceDesc kResources[] = {
	{ "positions", "attribute", perVertex<12> },
	{ "normals", "attribute", perVertex<12> },
	{ "directions", "attribute", perVertex<12> },
	{ "uvs", "attribute", perVertex<8> },
	{ "densities", "attribute", perVertex<4> },
	{ "color_uvs", "attribute", perVertex<8> },
	{ "colors", "attribute", perVertex<4> },
	{ "triangles", "buffer", perTriangle<4> },
	{ "first_seam_edges", "buffer", perTriangle<4> },
	{ "seam_edges", "buffer",
	  [](const PlanInput& input) -> uint64_t {
		  return input.sizes.seam_edges * sizeof(SeamEdge);
	  } },
	{ "seam_corner_indices", "attribute", perVertex<4> },
	{ "seam_corners", "buffer",
	  [](const PlanInput& input) -> uint64_t {
		  return input.sizes.seam_corners * sizeof(SeamCorner);
	  } },
	{ "clusters", "buffer", perCluster<sizeof(ClusterRecord)> },
	{ "cluster_bounds", "buffer", perCluster<sizeof(DisplacedBounds)> },
	{ "triangle_reaches", "buffer", perTriangle<sizeof(TriangleReach)> },
	{ "triangle_details", "buffer", perTriangle<sizeof(TriangleDetail)> },
	{ "edge_roughness", "buffer", perTriangle<sizeof(vec3)> },
	{ "meshes", "buffer", perMesh<sizeof(MeshRecord)> },
	{ "mesh_bounds", "buffer", perMesh<sizeof(DisplacedBounds)> },
	{ "instances", "buffer", perInstance<sizeof(InstanceRecord)> },
	{ "materials", "buffer", perMaterial<sizeof(MaterialRecord)> },
	{ "material_flags", "buffer", perMaterial<4> },
	{ "material_height_maps", "buffer", perMaterial<4> },
	{ "height_maps", "buffer",
	  [](const PlanInput& input) -> uint64_t {
		  return std::max<uint64_t>(input.sizes.height_maps, UNIFORM_HEIGHT_MAPS) * sizeof(HeightMap);
	  } },
	{ "height_texels", "texture",
	  [](const PlanInput& input) -> uint64_t {
		  return kHeightFootprints.holds(input) ? input.sizes.height_footprint_bytes : input.sizes.height_texel_bytes;
	  } },
	{ "color_textures", "texture",
	  [](const PlanInput& input) -> uint64_t {
		  return input.sizes.color_texture_bytes;
	  } },
	{ "patterns", "buffer", ofTable<&SceneSizes::patterns, sizeof(PatternRange)> },
	{ "table_vertices", "buffer", ofTable<&SceneSizes::table_vertices, sizeof(uint32_t)> },
	{ "table_triangles", "buffer", ofTable<&SceneSizes::table_triangles, sizeof(uint32_t)> },
	{ "view", "buffer", fixedBytes<sizeof(View)> },
	{ "surface", "buffer", fixedBytes<sizeof(Surface)> },
	{ "shading", "buffer", fixedBytes<sizeof(ShadingData)> },
	{ "heads", "buffer", fixedBytes<LIST_COUNT * sizeof(ListHead)> },
	{ "rate_steps", "buffer", fixedBytes<kMostRateSteps * sizeof(RateStep)> },
	{ "counts", "buffer", fixedBytes<sizeof(FrameCounts)> },
	{ "cluster_groups", "list", ofList<LIST_CLUSTER_GROUPS> },
	{ "visible_clusters", "list", ofList<LIST_VISIBLE_CLUSTERS> },
	{ "full_clusters", "list", ofList<LIST_FULL_CLUSTERS> },
	{ "split_triangles", "list", ofList<LIST_SPLIT_TRIANGLES> },
	{ "part_triangles", "list", ofList<LIST_PART_TRIANGLES> },
	{ "part_places", "list",
	  [](const PlanInput& input) -> uint64_t {
		  return ofList<LIST_PART_TRIANGLES>(input) / sizeof(DomainTriangle) * sizeof(PartPlace);
	  } },
	{ "window_seen", "list",
	  [](const PlanInput& input) -> uint64_t {
		  return (ofList<LIST_PART_TRIANGLES>(input) / sizeof(DomainTriangle) / BATCH_WINDOW + 1) * sizeof(uint32_t);
	  } },
	{ "batches", "list", ofList<LIST_BATCHES> },
	{ "left_items", "list",
	  [](const PlanInput& input) -> uint64_t {
		  return (ofList<LIST_BATCHES>(input) / sizeof(Batch) + ofList<LIST_FULL_CLUSTERS>(input) / sizeof(FullCluster)) * sizeof(uint32_t);
	  } },
	{ "micro_vertices", "list", ofList<LIST_MICRO_VERTICES> },
	{ "expanded_triangles", "list", ofList<LIST_EXPANDED_TRIANGLES> },
	{ "indexed_draw", "buffer", fixedBytes<20> },
	{ "ray_instances", "list",
	  [](const PlanInput& input) -> uint64_t {
		  return (kClusters.holds(input)           ? input.sizes.instances
				  : kSharesStructures.holds(input) ? 1 + input.sizes.instances
												   : 1) *
				 sizeof(RayInstance);
	  } },
	{ "shared_instances", "list", perInstance<sizeof(uint32_t)> },
	{ "shared_clusters", "list",
	  [](const PlanInput& input) -> uint64_t {
		  return input.sizes.instanced_clusters * sizeof(uint32_t);
	  } },
	{ "mesh_addresses", "buffer", perMesh<sizeof(uint64_t)> },
	{ "mesh_inputs", "list",
	  [](const PlanInput& input) -> uint64_t {
		  return input.sizes.vertices * sizeof(vec3) + input.sizes.triangles * 3 * sizeof(uint32_t);
	  } },
	{ "mesh_structures", "buffer",
	  [](const PlanInput& input) -> uint64_t {
		  return static_cast<uint64_t>(double(input.sizes.triangles) * input.device.structure_triangle_bytes);
	  } },
	{ "window_vertices", "list",
	  [](const PlanInput& input) -> uint64_t {
		  return (ofList<LIST_PART_TRIANGLES>(input) / sizeof(DomainTriangle) / BATCH_WINDOW + 1) * sizeof(uint32_t);
	  } },
	// What the driver asks for is known when they are made: about as much per triangle as for structures of triangles.
	{ "cluster_templates", "buffer",
	  [](const PlanInput& input) -> uint64_t {
		  return static_cast<uint64_t>(double(input.sizes.triangles + 2 * input.sizes.table_triangles) * input.device.structure_triangle_bytes);
	  } },
	{ "cluster_counts", "list", fixedBytes<sizeof(ClusterCounts)> },
	{ "instance_clusters", "list", perInstance<sizeof(InstanceClusters)> },
	{ "ray_inputs", "list", ofFirstClusters<sizeof(InstantiationInfo) + sizeof(DeviceAddress) + sizeof(ClusterPlace)> },
	{ "ray_references", "list", ofFirstClusters<sizeof(DeviceAddress)> },
	{ "ray_payloads", "list", ofFirstClusters<sizeof(uint32_t)> },
	{ "ray_clusters", "structure", ofTriangles<&DeviceTraits::structure_triangle_bytes> },
	{ "ray_geometry", "structure", ofTriangles<&DeviceTraits::structure_triangle_bytes> },
	{ "ray_scene", "structure",
	  [](const PlanInput& input) -> uint64_t {
		  return static_cast<uint64_t>(input.device.structure_instance_bytes);
	  } },
	{ "ray_scratch", "structure", ofTriangles<&DeviceTraits::structure_scratch_bytes> },
	{ "sun_visibility", "image", perPixel<4> },
	{ "ambient_visibility", "image", perPixel<4> },
	{ "visibility_depth", "image", perPixel<4> },
	{ "visibility_payload", "image", perPixel<4> },
	{ "visibility_buffer", "image", perPixel<8> },
	{ "kept_visibility", "image", perPixel<8> },
	{ "micro_dump", "buffer", fixedBytes<kFirstDump.bytes()> },
	{ "frame_history", "buffer", fixedBytes<sizeof(FrameHistory)> },
	{ "depth_pyramid", "buffer",
	  [](const PlanInput& input) -> uint64_t {
		  return 2 * uint64_t(pyramidFirst(input.options.width_px, input.options.height_px, PYRAMID_LEVELS)) * sizeof(float);
	  } },
	{ "hidden_instances", "buffer", perInstance<sizeof(HiddenInstance)> },
	{ "hidden_instances_next", "buffer", perInstance<sizeof(HiddenInstance)> },
	{ "picture", "image", perPixel<4> },
};

}  // namespace

std::span<const ResourceDesc> resourceDescs()
{
	return kResources;
}

}  // namespace tessera
