#include "frame/frame_resources.h"

#include "base/check.h"
#include "plan/conditions.h"
#include "raster/dump_micro.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tessera
{

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
	return upload("heads", std::as_bytes(std::span(heads)));
}

Status FrameResources::prepare(const FramePlan& plan, const PlanInput& input)
{
	bool lists_changed = !has("heads") || std::exchange(is_refitted_, false), tables_changed = false;
	if (lists_changed)
		dropUnkept(plan);
	for (const PlannedResource& resource : plan.resources)
	{
		const std::string name(resource.name);
		const bool exists = buffers_.count(name) > 0 || images_.count(name) > 0 || (name == "color_textures" && !textures_.empty());
		if (!resource.kept || exists)
			continue;
		TRY(make(resource.name, input));
		lists_changed |= findList(resource.name) != nullptr;
		tables_changed |= has(resource.name) && (resource.kind == "attribute" || resource.kind == "buffer");
	}
	// Tables of addresses: made again when something may have moved.
	if (!has("surface") || lists_changed || tables_changed)
	{
		TRY(makeSurface(plan));
		TRY(makeShadingData(plan));
		bindless_->writeUniform(4, buffer("surface").handle());
		bindless_->writeUniform(3, buffer("view").handle());
	}
	if (has("frame_history"))
		bindless_->writeUniform(6, buffer("frame_history").handle());
	TRY(prepareRays(plan, input));
	return lists_changed ? makeHeads() : Status{};
}

void FrameResources::dropUnkept(const FramePlan& plan)
{
	for (const PlannedResource& resource : plan.resources)
		if (!resource.kept && resource.name != "heads")
		{
			buffers_.erase(std::string(resource.name));
			images_.erase(std::string(resource.name));
		}
	if (!has("height_maps"))
		height_texels_.clear();
}

Status FrameResources::refit(const PlanInput& before, const PlanInput& after)
{
	const RenderOptions &was = before.options, &is = after.options;
	TRY_ASSIGN(const auto capacities, listCapacities(after));
	is_refitted_ = true;
	dropHidden();
	if (was.width_px != is.width_px || was.height_px != is.height_px)
	{
		has_pyramid_ = false;
		for (const char* name : { "picture", "visibility_buffer", "kept_visibility", "depth_pyramid", "sun_visibility", "ambient_visibility" })
			buffers_.erase(name);
		images_.clear();
	}
	if (buildsClusters(before) != buildsClusters(after))
		buffers_.erase("ray_instances");
	const bool same_limits = buildsClusters(before) == buildsClusters(after) && was.most_cluster_mib == is.most_cluster_mib &&
							 was.most_cluster_vertices == is.most_cluster_vertices;
	const bool same_lists = was.capacities == is.capacities && was.lists_bytes == is.lists_bytes && chosenRaster(before) == chosenRaster(after) &&
							tracesRays(before) == tracesRays(after) && (was.rate > 0) == (is.rate > 0) && same_limits;
	if (same_lists)
		return {};
	capacities_ = capacities;
	fixed_lists_ = 0;
	for (const ListDesc& list : listDescs())
		buffers_.erase(std::string(list.name));
	buffers_.erase("part_places");
	buffers_.erase("window_seen");
	buffers_.erase("window_vertices");
	buffers_.erase("left_items");
	return {};
}

bool FrameResources::grow(const ListDesc& list, uint32_t wanted, const PlanInput& input)
{
	const std::string name(list.name);
	if (!growsOnDemand(list) || !has(name) || (decidingLists(input) >> list.index & 1))
		return false;
	uint64_t capacity = std::min<uint64_t>(uint64_t(wanted) * 5 / 4, mostEntries(list));
	if (list.index == LIST_EXPANDED_TRIANGLES && kRayTriangles.holds(input))
		capacity = std::min(capacity, device_.limits.most_structure_triangles);
	if (list.index == LIST_MICRO_VERTICES && kClusters.holds(input))
		capacity = std::min<uint64_t>(capacity, input.options.most_cluster_vertices);
	buffers_.erase(name);
	auto made = Buffer::create(device_, listBufferBytes(list, static_cast<uint32_t>(capacity)), MemoryKind::Device, name);
	if (made)
	{
		buffers_[name] = std::move(*made);
		capacities_[list.index] = static_cast<uint32_t>(capacity);
	}
	else if (!allocate(name, listBufferBytes(list, capacities_[list.index])))
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
	const FrameCounts wanted = counts();
	const uint64_t items = uint64_t(head(LIST_FULL_CLUSTERS).wanted) + (has("batches") ? head(LIST_BATCHES).wanted : 0);
	if (items <= dump_.items && wanted.dump_vertices <= dump_.vertices && wanted.dump_triangles <= dump_.triangles)
		return false;
	const auto roomFor = [](uint64_t count, uint32_t held) {
		return uint32_t(std::clamp<uint64_t>(count * 5 / 4, held, UINT32_MAX));
	};
	buffers_.erase("micro_dump");
	TRY(makeDump({ roomFor(items, dump_.items), roomFor(wanted.dump_vertices, dump_.vertices), roomFor(wanted.dump_triangles, dump_.triangles) }));
	return true;
}

void FrameResources::writeHistory(const View& view, bool makes_pyramid)
{
	if (!has("frame_history"))
		return;
	const uint64_t pyramids = address("depth_pyramid"), bytes = buffer("depth_pyramid").bytes() / 2;
	FrameHistory history = {};
	had_history_ = makes_pyramid && has_pyramid_ && view_.width_px == view.width_px && view_.height_px == view.height_px;
	has_pyramid_ = makes_pyramid;
	history.has_last = had_history_ ? 1 : 0;
	history.last_view = view_;
	history.last_pyramid = pyramids + (pyramid_is_second_ ? bytes : 0);
	history.pyramid = pyramids + (pyramid_is_second_ ? 0 : bytes);
	pyramid_is_second_ = !pyramid_is_second_;
	vkCmdUpdateBuffer(commands_->buffer(), buffer("frame_history").handle(), 0, sizeof(history), &history);
}

bool FrameResources::takeHidden()
{
	hidden_source_ = HiddenSource::Measured;
	return counts().shown_instances > 0;
}

void FrameResources::writeHidden()
{
	const HiddenSource source = std::exchange(hidden_source_, HiddenSource::Kept);
	if (!has("hidden_instances") || source == HiddenSource::Kept)
		return;
	const Buffer& hidden = buffer("hidden_instances");
	if (source == HiddenSource::Nothing)
		vkCmdFillBuffer(commands_->buffer(), hidden.handle(), 0, VK_WHOLE_SIZE, 0);
	else
	{
		const VkBufferCopy copy = { 0, 0, hidden.bytes() };
		vkCmdCopyBuffer(commands_->buffer(), buffer("hidden_instances_next").handle(), hidden.handle(), 1, &copy);
	}
	fullBarrier(commands_->buffer());
}

Status FrameResources::writeView(const View& view, uint32_t round, bool makes_pyramid, std::span<const RateStep> steps)
{
	writeHistory(view, makes_pyramid);
	writeHidden();
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

void FrameResources::recordDrawView(const View& view) const
{
	// The device may have written the granted rate: only what a camera decides is replaced.
	fullBarrier(commands_->buffer());
	const auto update = [&](size_t first, size_t last) {
		vkCmdUpdateBuffer(commands_->buffer(), buffer("view").handle(), first, last - first, reinterpret_cast<const std::byte*>(&view) + first);
	};
	update(offsetof(View, right), offsetof(View, unit));
	update(offsetof(View, focal_x), offsetof(View, near));
	update(offsetof(View, ray_first), sizeof(View));
	fullBarrier(commands_->buffer());
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
		if (findList(name) || name == "heads" || name == "counts" || name == "rate_steps" || name == "part_places" || name == "window_seen" ||
			name == "window_vertices" || name == "left_items")
			memory.lists += held.bytes();
		else if (name == "picture" || name == "visibility_buffer" || name == "kept_visibility" || name == "depth_pyramid" ||
				 name == "sun_visibility" || name == "ambient_visibility")
			memory.images += held.bytes();
		else if (name == "ray_instances" || name == "hidden_instances" || name == "hidden_instances_next" || name == "shared_instances" ||
				 name == "shared_clusters")
			memory.rays += held.bytes();
		else
			memory.geometry += held.bytes();
	}
	for (const auto& [name, held] : images_)
		memory.images += held.bytes();
	for (const ImageResource& texture : textures_)
		memory.textures += texture.bytes();
	for (const Buffer& texels : height_texels_)
		memory.textures += texels.bytes();
	memory.rays += rays_.stats(0).total() + (clusters_.exists() ? clusters_.bytes() : 0) + shared_.bytes();
	return memory;
}

void FrameResources::recordCountsReadback(VkCommandBuffer commands) const
{
	fullBarrier(commands);
	const VkBufferCopy heads = { 0, 0, LIST_COUNT * sizeof(ListHead) };
	vkCmdCopyBuffer(commands, buffer("heads").handle(), readback_.handle(), 1, &heads);
	const VkBufferCopy counts = { 0, LIST_COUNT * sizeof(ListHead), sizeof(FrameCounts) };
	vkCmdCopyBuffer(commands, buffer("counts").handle(), readback_.handle(), 1, &counts);
	if (clusters_.exists())
		clusters_.recordCountsReadback(commands);
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
