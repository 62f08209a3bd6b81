#include "frame/frame_resources.h"

#include "base/check.h"
#include "frame/color_mips.h"
#include "raster/dump_micro.h"
#include "shading/material_record.h"

#include <algorithm>
#include <cstring>

namespace tessera
{

namespace
{

// A scene array by the name that passes use for it.
struct SceneArray
{
	std::string_view name;
	std::span<const std::byte> (*bytes)(const BuiltScene& scene);
};

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
	{ "colors", bytesOf<&BuiltScene::colors> },
	{ "triangles", bytesOf<&BuiltScene::triangles> },
	{ "first_seam_edges", bytesOf<&BuiltScene::first_seam_edges> },
	{ "seam_edges", bytesOf<&BuiltScene::seam_edges> },
	{ "seam_corner_indices", bytesOf<&BuiltScene::seam_corner_indices> },
	{ "seam_corners", bytesOf<&BuiltScene::seam_corners> },
	{ "clusters", bytesOf<&BuiltScene::clusters> },
	{ "cluster_bounds", bytesOf<&BuiltScene::cluster_bounds> },
	{ "triangle_reaches", bytesOf<&BuiltScene::triangle_reaches> },
	{ "meshes", bytesOf<&BuiltScene::meshes> },
	{ "mesh_bounds", bytesOf<&BuiltScene::mesh_bounds> },
	{ "material_height_maps", bytesOf<&BuiltScene::material_height_maps> },
};

std::vector<InstanceRecord> instanceRecords(const BuiltScene& scene)
{
	std::vector<InstanceRecord> records;
	records.reserve(scene.instances.size());
	for (const Instance& instance : scene.instances)
		records.push_back(instanceRecord(instance));
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

Result<std::unique_ptr<FrameResources>> FrameResources::create(Device& device, const BuiltScene& scene, const TessellationTable& table,
															   const PlanInput& input)
{
	std::unique_ptr<FrameResources> resources(new FrameResources(device, scene, table));
	TRY_ASSIGN(resources->capacities_, listCapacities(input));
	TRY_ASSIGN(resources->commands_, CommandRecorder::create(device));
	TRY_ASSIGN(resources->bindless_, BindlessSet::create(device));
	TRY_ASSIGN(resources->readback_,
			   Buffer::create(device, LIST_COUNT * sizeof(ListHead) + sizeof(FrameCounts), MemoryKind::Readback, "counts readback"));
	return resources;
}

FrameResources::~FrameResources()
{
	for (VkSampler sampler : samplers_)
		vkDestroySampler(device_.handle, sampler, nullptr);
}

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

Status FrameResources::makeHeads()
{
	std::vector<ListHead> heads(LIST_COUNT);
	for (const ListDesc& list : listDescs())
	{
		ListHead& head = heads[list.index];
		// A list that this plan does not hold has room for nothing: whatever is wanted of it makes the frame plan again.
		head.capacity = has(list.name) ? capacities_[list.index] : 0;
		head.group_width = std::max(32u, (capacities_[list.index] + device_.limits.max_mesh_rows - 1) / device_.limits.max_mesh_rows);
		head.group_depth = 1;
		if (!has("heads"))
			continue;
		const ListHead before = this->head(list.index);
		head.peak = before.peak;
		head.peak_used = before.peak_used;
	}
	return upload("heads", asBytes(heads));
}

Status FrameResources::makeHeightMaps()
{
	std::vector<HeightMap> records;
	for (const HeightMapData& map : scene_.height_maps)
	{
		TRY_ASSIGN(Buffer texels, uploadBuffer(device_, *commands_, asBytes(map.texels), "height texels " + map.name));
		records.push_back(map.record);
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
	surface.directions = scene_.traits.directions_are_normals ? kept("normals") : kept("directions");
	surface.uvs = kept("uvs");
	surface.densities = kept("densities");
	surface.triangles = kept("triangles");
	surface.first_seam_edges = kept("first_seam_edges");
	surface.seam_edges = kept("seam_edges");
	surface.seam_corner_indices = kept("seam_corner_indices");
	surface.seam_corners = kept("seam_corners");
	surface.material_height_maps = kept("material_height_maps");
	surface.height_maps = kept("height_maps");
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

bool FrameResources::makesSceneArray(std::string_view name, Status& status)
{
	const auto found = std::find_if(std::begin(kSceneArrays), std::end(kSceneArrays), [&](const SceneArray& array) { return array.name == name; });
	if (found == std::end(kSceneArrays))
		return false;
	status = upload(name, found->bytes(scene_));
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
	if (makesSceneArray(name, status))
		return status;
	if (const ListDesc* list = findList(name))
		return allocate(name, listBytes(*list, capacities_[list->index]));
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
		return makeHeightMaps();
	if (name == "color_textures")
		return makeTextures();
	if (name == "picture")
		return allocate(name, uint64_t(input.options.width_px) * input.options.height_px * 4);
	if (name == "visibility_buffer")
		return allocateEmpty(name, uint64_t(input.options.width_px) * input.options.height_px * 8);
	if (name == "kept_visibility")
		return allocate(name, uint64_t(input.options.width_px) * input.options.height_px * 8);
	if (name == "micro_dump")
		return allocate(name, kFirstDumpItems * sizeof(DumpItem));
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
	if (name == "frame_history")
		return allocate(name, sizeof(FrameHistory));
	if (name == "depth_pyramid")
		return allocateEmpty(name, 2 * pyramidBytes(input));
	if (name == "indexed_draw")
		return allocate(name, 20);
	CHECK(name == "heads" || name == "surface" || name == "shading" || name == "height_texels", "nobody makes resource '{}'", name);
	return {};
}

Status FrameResources::prepare(const FramePlan& plan, const PlanInput& input)
{
	bool lists_changed = !has("heads");
	for (const PlannedResource& resource : plan.resources)
	{
		const std::string name(resource.name);
		const bool exists = buffers_.count(name) > 0 || images_.count(name) > 0 || (name == "color_textures" && !textures_.empty());
		if (!resource.kept || exists)
			continue;
		TRY(make(resource.name, input));
		lists_changed |= findList(resource.name) != nullptr;
	}
	if (!has("surface"))
	{
		TRY(makeSurface(plan));
		bindless_->writeUniform(4, buffer("surface").handle());
		bindless_->writeUniform(3, buffer("view").handle());
	}
	if (has("frame_history"))
		bindless_->writeUniform(6, buffer("frame_history").handle());
	if (!has("shading"))
		TRY(makeShadingData(plan));
	return lists_changed ? makeHeads() : Status{};
}

bool FrameResources::grow(const ListDesc& list, uint32_t wanted, const PlanInput& input)
{
	const std::string name(list.name);
	if (!growsOnDemand(list) || !has(name) || (decidingLists(input) >> list.index & 1))
		return false;
	const uint64_t capacity = std::min<uint64_t>(uint64_t(wanted) * 5 / 4, mostEntries(list));
	buffers_.erase(name);
	auto made = Buffer::create(device_, listBytes(list, static_cast<uint32_t>(capacity)), MemoryKind::Device, name);
	if (made)
	{
		buffers_[name] = std::move(*made);
		capacities_[list.index] = static_cast<uint32_t>(capacity);
	}
	else if (!allocate(name, listBytes(list, capacities_[list.index])))
		return false;
	if (!made || capacity < wanted)
		fixed_lists_ |= 1u << list.index;
	return makeHeads().has_value();
}

uint32_t FrameResources::decidingLists(const PlanInput& input) const
{
	uint32_t lists = 0;
	for (const ListDesc& list : listDescs())
	{
		const bool is_fixed = (fixed_lists_ >> list.index & 1) || isFixed(list, input.options);
		const bool decides = growsOnDemand(list) ? is_fixed && has(list.name) : list.index != LIST_BATCHES;
		lists |= decides ? 1u << list.index : 0;
	}
	return lists;
}

Result<bool> FrameResources::growDump()
{
	if (!has("micro_dump"))
		return false;
	const uint64_t items = uint64_t(head(LIST_FULL_CLUSTERS).wanted) + (has("batches") ? head(LIST_BATCHES).wanted : 0);
	if (items * sizeof(DumpItem) <= buffer("micro_dump").bytes())
		return false;
	buffers_.erase("micro_dump");
	TRY(allocate("micro_dump", items * 5 / 4 * sizeof(DumpItem)));
	return true;
}

void FrameResources::writeHistory(const View& view, bool makes_pyramid)
{
	if (!has("frame_history"))
		return;
	const uint64_t pyramids = address("depth_pyramid"), bytes = buffer("depth_pyramid").bytes() / 2;
	FrameHistory history = {};
	had_history_ = has_pyramid_ && view_.width_px == view.width_px && view_.height_px == view.height_px;
	has_pyramid_ = makes_pyramid;
	history.has_last = had_history_ ? 1 : 0;
	history.last_view = view_;
	history.last_pyramid = pyramids + (pyramid_is_second_ ? bytes : 0);
	history.pyramid = pyramids + (pyramid_is_second_ ? 0 : bytes);
	pyramid_is_second_ = !pyramid_is_second_;
	vkCmdUpdateBuffer(commands_->buffer(), buffer("frame_history").handle(), 0, sizeof(history), &history);
}

Status FrameResources::writeView(const View& view, uint32_t round, bool makes_pyramid, std::span<const RateStep> steps)
{
	writeHistory(view, makes_pyramid);
	round_ = round;
	view_ = view;
	vkCmdUpdateBuffer(commands_->buffer(), buffer("view").handle(), 0, sizeof(View), &view);
	const auto steps_bytes = std::as_bytes(steps);
	if (!steps.empty() && !std::ranges::equal(steps_bytes, std::as_bytes(std::span(steps_))))
	{
		steps_.assign(steps.begin(), steps.end());
		vkCmdUpdateBuffer(commands_->buffer(), buffer("rate_steps").handle(), 0, steps_bytes.size(), steps.data());
	}
	VkMemoryBarrier2 barrier = { VK_STRUCTURE_TYPE_MEMORY_BARRIER_2 };
	barrier.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
	barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
	barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
	barrier.dstAccessMask = VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT;
	VkDependencyInfo info = { VK_STRUCTURE_TYPE_DEPENDENCY_INFO };
	info.memoryBarrierCount = 1;
	info.pMemoryBarriers = &barrier;
	vkCmdPipelineBarrier2(commands_->buffer(), &info);
	return {};
}

void FrameResources::clearVisibility()
{
	if (!has("visibility_buffer"))
		return;
	vkCmdFillBuffer(commands_->buffer(), buffer("visibility_buffer").handle(), 0, VK_WHOLE_SIZE, 0);
	fullBarrier(commands_->buffer());
}

uint64_t FrameResources::address(std::string_view name) const
{
	return buffer(name).address();
}

const Buffer& FrameResources::buffer(std::string_view name) const
{
	const auto found = buffers_.find(std::string(name));
	CHECK(found != buffers_.end(), "no buffer '{}'", name);
	return found->second;
}

const ImageResource& FrameResources::image(std::string_view name) const
{
	const auto found = images_.find(std::string(name));
	CHECK(found != images_.end(), "no image '{}'", name);
	return found->second;
}

uint64_t FrameResources::headOffset(std::string_view list) const
{
	const ListDesc* desc = findList(list);
	CHECK(desc, "no list '{}'", list);
	return desc->index * sizeof(ListHead);
}

uint32_t FrameResources::capacity(std::string_view list) const
{
	const ListDesc* desc = findList(list);
	CHECK(desc, "no list '{}'", list);
	return capacities_[desc->index];
}

MemoryStats FrameResources::memory() const
{
	MemoryStats memory;
	for (const auto& [name, held] : buffers_)
	{
		if (findList(name) || name == "heads" || name == "counts" || name == "rate_steps" || name == "part_places" || name == "window_seen")
			memory.lists += held.bytes();
		else if (name == "picture" || name == "visibility_buffer" || name == "kept_visibility" || name == "depth_pyramid")
			memory.images += held.bytes();
		else
			memory.geometry += held.bytes();
	}
	for (const auto& [name, held] : images_)
		memory.images += held.bytes();
	for (const ImageResource& texture : textures_)
		memory.textures += texture.bytes();
	for (const Buffer& texels : height_texels_)
		memory.textures += texels.bytes();
	return memory;
}

void FrameResources::recordCountsReadback(VkCommandBuffer commands) const
{
	fullBarrier(commands);
	const VkBufferCopy heads = { 0, 0, LIST_COUNT * sizeof(ListHead) };
	vkCmdCopyBuffer(commands, buffer("heads").handle(), readback_.handle(), 1, &heads);
	const VkBufferCopy counts = { 0, LIST_COUNT * sizeof(ListHead), sizeof(FrameCounts) };
	vkCmdCopyBuffer(commands, buffer("counts").handle(), readback_.handle(), 1, &counts);
	fullBarrier(commands);
}

ListHead FrameResources::head(uint32_t list) const
{
	readback_.invalidateMapped();
	ListHead head;
	std::memcpy(&head, readback_.mapped() + list * sizeof(ListHead), sizeof(head));
	return head;
}

FrameCounts FrameResources::counts() const
{
	readback_.invalidateMapped();
	FrameCounts counts;
	std::memcpy(&counts, readback_.mapped() + LIST_COUNT * sizeof(ListHead), sizeof(counts));
	return counts;
}

Result<std::vector<std::byte>> FrameResources::read(std::string_view name, uint64_t bytes)
{
	const bool is_image = images_.count(std::string(name)) > 0;
	const uint64_t size = is_image ? uint64_t(image(name).desc().width) * image(name).desc().height * 4 : std::min(bytes, buffer(name).bytes());
	TRY_ASSIGN(const Buffer target, Buffer::create(device_, size, MemoryKind::Readback, "readback"));
	TRY(commands_->begin());
	fullBarrier(commands_->buffer());
	if (is_image)
	{
		VkBufferImageCopy copy = {};
		copy.imageSubresource = { image(name).desc().aspect, 0, 0, 1 };
		copy.imageExtent = { image(name).desc().width, image(name).desc().height, 1 };
		vkCmdCopyImageToBuffer(commands_->buffer(), image(name).handle(), VK_IMAGE_LAYOUT_GENERAL, target.handle(), 1, &copy);
	}
	else if (size > 0)
	{
		const VkBufferCopy copy = { 0, 0, size };
		vkCmdCopyBuffer(commands_->buffer(), buffer(name).handle(), target.handle(), 1, &copy);
	}
	fullBarrier(commands_->buffer());
	TRY(commands_->submitAndWait());
	target.invalidateMapped();
	return std::vector<std::byte>(target.mapped(), target.mapped() + size);
}

}  // namespace tessera
