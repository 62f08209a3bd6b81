// Makes and fills the buffers and images of FrameResources.
#include "base/check.h"
#include "frame/color_mips.h"
#include "frame/frame_resources.h"
#include "frame/height_footprints.h"
#include "plan/conditions.h"
#include "raster/dump_micro.h"
#include "raytracing/place_instances.h"
#include "shading/material_record.h"

#include <algorithm>

namespace tessera
{

namespace
{

// A scene array by the name that passes use for it.
struct SceneArray
{
	std::string_view name;
	std::span<const std::byte> (*bytes)(const BuiltScene& scene);
	uint8_t nothing = 0;  // what every byte is in the array of a scene that has none, where it is kept all the same (--force)
};
constexpr uint8_t kNoIndex = 0xff;  // NO_INDEX, or white

template <auto member>
std::span<const std::byte> bytesOf(const BuiltScene& scene)
{
	return std::as_bytes(std::span((scene.*member).data(), (scene.*member).size()));
}

constexpr SceneArray kSceneArrays[] = {
	{ "positions", bytesOf<&BuiltScene::positions> },
	{ "directions", bytesOf<&BuiltScene::directions> },
	{ "normals", bytesOf<&BuiltScene::normals> },
	{ "uvs", bytesOf<&BuiltScene::uvs> },
	{ "densities", bytesOf<&BuiltScene::densities> },
	{ "color_uvs", bytesOf<&BuiltScene::color_uvs> },
	{ "colors", bytesOf<&BuiltScene::colors>, kNoIndex },
	{ "triangles", bytesOf<&BuiltScene::triangles> },
	{ "first_seam_edges", bytesOf<&BuiltScene::first_seam_edges> },
	{ "seam_edges", bytesOf<&BuiltScene::seam_edges> },
	{ "seam_corner_indices", bytesOf<&BuiltScene::seam_corner_indices>, kNoIndex },
	{ "seam_corners", bytesOf<&BuiltScene::seam_corners> },
	{ "clusters", bytesOf<&BuiltScene::clusters> },
	{ "cluster_bounds", bytesOf<&BuiltScene::cluster_bounds> },
	{ "triangle_reaches", bytesOf<&BuiltScene::triangle_reaches> },
	{ "triangle_details", bytesOf<&BuiltScene::triangle_details> },
	{ "edge_roughness", bytesOf<&BuiltScene::edge_roughness> },
	{ "meshes", bytesOf<&BuiltScene::meshes> },
	{ "mesh_bounds", bytesOf<&BuiltScene::mesh_bounds> },
	{ "material_height_maps", bytesOf<&BuiltScene::material_height_maps>, kNoIndex },
};

// Vertices and triangles of a mesh, whose clusters cover both without gaps in some order.
struct MeshRanges
{
	uint32_t first_vertex = UINT32_MAX, vertex_end = 0, first_triangle = UINT32_MAX, triangle_end = 0;
};

std::vector<MeshRanges> meshRanges(const BuiltScene& scene)
{
	std::vector<MeshRanges> ranges(scene.meshes.size());
	for (size_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
		for (const ClusterRecord& cluster : std::span(scene.clusters).subspan(scene.meshes[mesh].first_cluster, scene.meshes[mesh].cluster_count))
		{
			MeshRanges& range = ranges[mesh];
			range.first_vertex = std::min(range.first_vertex, cluster.first_vertex);
			range.vertex_end = std::max(range.vertex_end, cluster.first_vertex + clusterVertices(cluster));
			range.first_triangle = std::min(range.first_triangle, cluster.first_triangle);
			range.triangle_end = std::max(range.triangle_end, cluster.first_triangle + clusterTriangles(cluster));
		}
	return ranges;
}

// One instance's places behind the other's.
std::vector<InstanceRecord> instanceRecords(const BuiltScene& scene)
{
	const std::vector<MeshRanges> ranges = meshRanges(scene);
	std::vector<InstanceRecord> records;
	records.reserve(scene.instances.size());
	uint32_t vertices = 0, triangles = 0;
	for (const Instance& instance : scene.instances)
	{
		const MeshRanges& range = ranges[instance.mesh];
		InstanceRecord record = instanceRecord(instance, scene.mesh_bounds[instance.mesh]);
		record.vertex_place = vertices - range.first_vertex;
		record.triangle_place = triangles - range.first_triangle;
		records.push_back(record);
		vertices += range.vertex_end - range.first_vertex;
		triangles += range.triangle_end - range.first_triangle;
	}
	return records;
}

std::vector<MaterialRecord> materialRecords(const BuiltScene& scene)
{
	std::vector<MaterialRecord> records;
	for (const MaterialData& material : scene.materials)
	{
		MaterialRecord record = {};
		record.base_color = material.base_color;
		record.emissive = material.emissive;
		record.metallic = material.metallic;
		record.roughness = material.roughness;
		record.color_texture = material.base_color_texture;
		records.push_back(record);
	}
	return records;
}

std::vector<uint32_t> materialFlags(const BuiltScene& scene)
{
	std::vector<uint32_t> flags;
	for (const MaterialData& material : scene.materials)
		flags.push_back(material.double_sided ? MATERIAL_DOUBLE_SIDED : 0);
	return flags;
}

std::vector<PatternRange> patternRanges(const TessellationTable& table)
{
	std::vector<PatternRange> ranges;
	for (const TableConfig& config : table.configs)
		ranges.push_back({ config.first_triangle, config.first_vertex, config.triangle_count | uint32_t(config.vertex_count) << 16 });
	return ranges;
}

template <typename T>
std::span<const std::byte> asBytes(const std::vector<T>& values)
{
	return std::as_bytes(std::span(values));
}

}  // namespace

Status FrameResources::upload(std::string_view name, std::span<const std::byte> bytes)
{
	TRY_ASSIGN(Buffer made, uploadBuffer(device_, *commands_, bytes, std::string(name)));
	buffers_[std::string(name)] = std::move(made);
	return {};
}

Status FrameResources::allocate(std::string_view name, uint64_t bytes)
{
	TRY_ASSIGN(Buffer made, Buffer::create(device_, bytes, MemoryKind::Device, std::string(name)));
	buffers_[std::string(name)] = std::move(made);
	return {};
}

Status FrameResources::allocateEmpty(std::string_view name, uint64_t bytes)
{
	TRY(allocate(name, bytes));
	TRY(commands_->begin());
	vkCmdFillBuffer(commands_->buffer(), buffer(name).handle(), 0, VK_WHOLE_SIZE, 0);
	fullBarrier(commands_->buffer());
	return commands_->submitAndWait();
}

Status FrameResources::makeDump(const DumpLayout& layout)
{
	dump_ = layout;
	TRY(allocate("micro_dump", layout.bytes()));
	const uint64_t begin = address("micro_dump");
	const DumpHead head = {
		begin + layout.firstItem(), begin + layout.firstVertex(), begin + layout.firstTriangle(), layout.items, layout.vertices, layout.triangles, 0
	};
	TRY(commands_->begin());
	vkCmdUpdateBuffer(commands_->buffer(), buffer("micro_dump").handle(), 0, sizeof head, &head);
	fullBarrier(commands_->buffer());
	return commands_->submitAndWait();
}

Status FrameResources::makeHeightMaps(const PlanInput& input)
{
	const bool kept_footprints = kHeightFootprints.holds(input);
	std::vector<HeightMap> records;
	for (const HeightMapData& map : scene_.height_maps)
	{
		const HeightFootprints footprints = kept_footprints ? heightFootprints(map) : HeightFootprints{ map.record, {} };
		TRY_ASSIGN(Buffer texels,
				   uploadBuffer(device_, *commands_, asBytes(kept_footprints ? footprints.texels : map.texels), "height texels " + map.name));
		records.push_back(footprints.record);
		records.back().texels = texels.address();
		height_texels_.push_back(std::move(texels));
	}
	// The uniform block has a fixed size.
	records.resize(std::max<size_t>(records.size(), UNIFORM_HEIGHT_MAPS));
	TRY(upload("height_maps", asBytes(records)));
	if (scene_.height_maps.size() <= UNIFORM_HEIGHT_MAPS)
		bindless_->writeUniform(5, buffer("height_maps").handle());
	return {};
}

Status FrameResources::makeSurface(const FramePlan& plan)
{
	const auto kept = [&](std::string_view name) {
		return plan.keeps(name) ? address(name) : 0;
	};
	Surface surface = {};
	surface.positions = kept("positions");
	surface.directions = plan.keeps("directions") ? kept("directions") : kept("normals");
	surface.uvs = kept("uvs");
	surface.densities = kept("densities");
	surface.triangles = kept("triangles");
	surface.first_seam_edges = kept("first_seam_edges");
	surface.seam_edges = kept("seam_edges");
	surface.seam_corner_indices = kept("seam_corner_indices");
	surface.seam_corners = kept("seam_corners");
	surface.material_height_maps = kept("material_height_maps");
	surface.height_maps = kept("height_maps");
	surface.triangle_details = kept("triangle_details");
	surface.edge_roughness = kept("edge_roughness");
	surface.pn_directions = scene_.traits.has_pn ? surface.directions : 0;
	surface.hidden_instances = kept("hidden_instances");
	return upload("surface", std::as_bytes(std::span(&surface, 1)));
}

Status FrameResources::makeShadingData(const FramePlan& plan)
{
	const auto kept = [&](std::string_view name) {
		return plan.keeps(name) ? address(name) : 0;
	};
	const ShadingData shading = { kept("normals"), kept("color_uvs"), kept("colors"), kept("materials") };
	return upload("shading", std::as_bytes(std::span(&shading, 1)));
}

Status FrameResources::makeImage(const ImageDesc& desc, uint32_t binding)
{
	TRY_ASSIGN(ImageResource made, ImageResource::create(device_, desc));
	TRY(commands_->begin());
	toGeneralLayout(commands_->buffer(), made);
	TRY(commands_->submitAndWait());
	bindless_->writeImage(binding, made.view());
	images_[desc.name] = std::move(made);
	return {};
}

Status FrameResources::makeTextures()
{
	if (scene_.color_textures.size() > kMaxTextures)
		return badInput("{}: {} colour textures are too many, at most {} can be used", scene_.path, scene_.color_textures.size(), kMaxTextures);
	for (const ColorTexture& texture : scene_.color_textures)
	{
		TRY_ASSIGN(ImageResource image, uploadColorTexture(device_, *commands_, texture));
		TRY_ASSIGN(const VkSampler sampler, makeColorSampler(device_, texture));
		bindless_->writeTexture(static_cast<uint32_t>(textures_.size()), image.view(), sampler);
		samplers_.push_back(sampler);
		textures_.push_back(std::move(image));
	}
	return {};
}

bool FrameResources::makesSceneArray(std::string_view name, const PlanInput& input, Status& status)
{
	const auto found = std::find_if(std::begin(kSceneArrays), std::end(kSceneArrays), [&](const SceneArray& array) { return array.name == name; });
	if (found == std::end(kSceneArrays))
		return false;
	const std::span<const std::byte> bytes = found->bytes(scene_);
	if (!bytes.empty())
	{
		status = upload(name, bytes);
		return true;
	}
	const std::span<const ResourceDesc> descs = resourceDescs();
	const auto desc = std::find_if(descs.begin(), descs.end(), [&](const ResourceDesc& d) { return d.name == name; });
	CHECK(desc != descs.end(), "no resource '{}'", name);
	status = upload(name, std::vector(desc->bytes(input), std::byte(found->nothing)));
	return true;
}

static uint64_t pyramidBytes(const PlanInput& input)
{
	const uint64_t bytes = uint64_t(pyramidFirst(input.options.width_px, input.options.height_px, PYRAMID_LEVELS)) * sizeof(float);
	return (bytes + 15) / 16 * 16;  // arrays begin on 16-byte boundaries
}

Status FrameResources::make(std::string_view name, const PlanInput& input)
{
	Status status;
	if (makesSceneArray(name, input, status))
		return status;
	if (const ListDesc* list = findList(name))
		return allocate(name, listBufferBytes(*list, capacities_[list->index]));
	const ImageDesc size = { std::string(name), VK_FORMAT_R32_UINT, input.options.width_px, input.options.height_px };
	if (name == "visibility_payload")
	{
		ImageDesc payload = size;
		payload.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
		return makeImage(payload, 1);
	}
	if (name == "visibility_depth")
	{
		ImageDesc depth = size;
		depth.format = VK_FORMAT_D32_SFLOAT;
		depth.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
		depth.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
		return makeImage(depth, 2);
	}
	if (name == "instances")
		return upload(name, asBytes(instanceRecords(scene_)));
	if (name == "materials")
		return upload(name, asBytes(materialRecords(scene_)));
	if (name == "material_flags")
		return upload(name, asBytes(materialFlags(scene_)));
	if (name == "patterns")
		return upload(name, asBytes(patternRanges(table_)));
	if (name == "table_vertices")
		return upload(name, asBytes(table_.vertices));
	if (name == "table_triangles")
		return upload(name, asBytes(table_.triangles));
	if (name == "height_maps")
		return makeHeightMaps(input);
	if (name == "color_textures")
		return makeTextures();
	if (name == "picture")
		return allocate(name, uint64_t(input.options.width_px) * input.options.height_px * 4);
	if (name == "visibility_buffer")
		return allocateEmpty(name, uint64_t(input.options.width_px) * input.options.height_px * 8);
	if (name == "kept_visibility")
		return allocate(name, uint64_t(input.options.width_px) * input.options.height_px * 8);
	if (name == "micro_dump")
		return makeDump(dump_);
	if (name == "view")
		return allocate(name, sizeof(View));
	if (name == "rate_steps")
		return allocate(name, kMostRateSteps * sizeof(RateStep));
	if (name == "counts")
		return allocate(name, sizeof(FrameCounts));
	if (name == "part_places")
		return allocate(name, uint64_t(capacities_[LIST_PART_TRIANGLES]) * sizeof(PartPlace));
	if (name == "window_seen")
		return allocate(name, (uint64_t(capacities_[LIST_PART_TRIANGLES]) / BATCH_WINDOW + 1) * sizeof(uint32_t));
	if (name == "window_vertices")
		return allocate(name, (uint64_t(capacities_[LIST_PART_TRIANGLES]) / BATCH_WINDOW + 1) * sizeof(uint32_t));
	if (name == "left_items")
		return allocate(name, (uint64_t(capacities_[LIST_BATCHES]) + capacities_[LIST_FULL_CLUSTERS]) * sizeof(uint32_t));
	if (name == "frame_history")
		return allocate(name, sizeof(FrameHistory));
	if (name == "depth_pyramid")
		return allocateEmpty(name, 2 * pyramidBytes(input));
	if (name == "hidden_instances" || name == "hidden_instances_next")
		return allocateEmpty(name, scene_.instances.size() * sizeof(HiddenInstance));
	if (name == "indexed_draw")
		return allocate(name, 20);
	if (name == "sun_visibility" || name == "ambient_visibility")
		return allocate(name, uint64_t(input.options.width_px) * input.options.height_px * sizeof(float));
	if (name == "ray_instances")
		return allocate(name, rayInstanceBytes(input));
	if (name == "shared_instances")
		return allocate(name, scene_.instances.size() * sizeof(uint32_t));
	if (name == "shared_clusters")
		return allocate(name, input.sizes.instanced_clusters * sizeof(uint32_t));
	constexpr std::string_view kOfRays[] = { "cluster_templates", "cluster_counts", "instance_clusters", "ray_inputs",  "ray_references",
											 "ray_payloads",      "ray_clusters",   "mesh_addresses",    "mesh_inputs", "mesh_structures" };
	CHECK(std::ranges::find(kOfRays, name) != std::end(kOfRays) || name == "ray_geometry" || name == "ray_scene" || name == "ray_scratch" ||
			  name == "heads" || name == "surface" || name == "shading" || name == "height_texels",
		  "nobody makes resource '{}'", name);
	return {};
}

}  // namespace tessera
