#include "layer/recording.h"

#include "layer/device.h"

#include <utility>

namespace tessera::layer
{

void Recordings::allocated(const VkCommandBufferAllocateInfo& info, const VkCommandBuffer* buffers)
{
	const std::lock_guard guard(lock_);
	for (uint32_t i = 0; i < info.commandBufferCount; ++i)
	{
		Recording& recording = all_[buffers[i]] = {};
		recording.pool = info.commandPool;
		recording.level = info.level;
		recording.current = buffers[i];
	}
}

void Recordings::dropSegments(Device& device, VkCommandBuffer buffer, Recording& recording)
{
	std::vector<VkCommandBuffer> extra;
	for (const Step& step : recording.steps)
		if (step.segment != buffer)
			extra.push_back(step.segment);
	if (recording.current != buffer)
		extra.push_back(recording.current);
	if (!extra.empty())
		device.next.FreeCommandBuffers(device.handle, recording.pool, static_cast<uint32_t>(extra.size()), extra.data());
	Recording fresh;
	fresh.pool = recording.pool;
	fresh.level = recording.level;
	fresh.current = buffer;
	recording = std::move(fresh);
}

void Recordings::began(Device& device, VkCommandBuffer buffer, const VkCommandBufferBeginInfo& info)
{
	reset(device, buffer);
	if (Recording* recording = find(buffer))
		recording->flags = info.flags;
}

void Recordings::reset(Device& device, VkCommandBuffer buffer)
{
	const std::lock_guard guard(lock_);
	if (const auto found = all_.find(buffer); found != all_.end())
		dropSegments(device, buffer, found->second);
}

void Recordings::resetPool(Device& device, VkCommandPool pool)
{
	const std::lock_guard guard(lock_);
	for (auto& [buffer, recording] : all_)
		if (recording.pool == pool)
			dropSegments(device, buffer, recording);
}

void Recordings::freed(Device& device, VkCommandBuffer buffer)
{
	const std::lock_guard guard(lock_);
	const auto found = all_.find(buffer);
	if (found == all_.end())
		return;
	dropSegments(device, buffer, found->second);
	all_.erase(found);
}

void Recordings::poolDestroyed(VkCommandPool pool)
{
	const std::lock_guard guard(lock_);
	std::erase_if(all_, [&](const auto& entry) { return entry.second.pool == pool; });
}

Recording* Recordings::find(VkCommandBuffer buffer)
{
	const std::lock_guard guard(lock_);
	const auto found = all_.find(buffer);
	return found == all_.end() ? nullptr : &found->second;
}

namespace
{

// Why a segment cannot end here; empty when it can.
std::string cannotSplit(const Recording& recording)
{
	if (recording.level == VK_COMMAND_BUFFER_LEVEL_SECONDARY)
		return "in a secondary command buffer; record it into a primary one";
	if (recording.open > 0)
		return fmt::format("between vkCmd{} and its end; record it outside", recording.opened_by);
	if (!recording.state.unkept().empty())
		return fmt::format("after vkCmd{}, whose state the layer cannot set again; record it before", recording.state.unkept());
	return {};
}

}  // namespace

void recordHostCommand(Device& device, VkCommandBuffer buffer, HostCommand command, const char* name)
{
	Recording* recording = device.recordings.find(buffer);
	if (!recording)
		return;
	if (const std::string why = cannotSplit(*recording); !why.empty())
		device.report.limit("limit-segment", "{} {}", name, why);
	if (recording->level == VK_COMMAND_BUFFER_LEVEL_SECONDARY || recording->open > 0)
		return;
	VkCommandBufferAllocateInfo allocation = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, recording->pool };
	allocation.commandBufferCount = 1;
	VkCommandBuffer next = VK_NULL_HANDLE;
	recording->state.endLabels(device.next, recording->current);
	if (device.next.EndCommandBuffer(recording->current) != VK_SUCCESS ||
		device.next.AllocateCommandBuffers(device.handle, &allocation, &next) != VK_SUCCESS)
	{
		device.report.limit("limit-memory", "{}: no memory for another command buffer", name);
		return;
	}
	if (device.set_loader_data)
		device.set_loader_data(device.handle, next);
	recording->steps.push_back({ recording->current, std::move(command), recording->epoch });
	recording->current = next;
	VkCommandBufferBeginInfo begin = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
	begin.flags = recording->flags;
	device.next.BeginCommandBuffer(next, &begin);
	recording->state.replay(device.next, next);
}

VKAPI_ATTR VkResult VKAPI_CALL allocateCommandBuffers(VkDevice handle, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* buffers)
{
	Device& device = deviceOf(handle);
	const VkResult result = device.next.AllocateCommandBuffers(handle, info, buffers);
	if (device.active && result == VK_SUCCESS)
		device.recordings.allocated(*info, buffers);
	return result;
}

VKAPI_ATTR void VKAPI_CALL freeCommandBuffers(VkDevice handle, VkCommandPool pool, uint32_t count, const VkCommandBuffer* buffers)
{
	Device& device = deviceOf(handle);
	if (device.active)
		for (uint32_t i = 0; i < count; ++i)
			device.recordings.freed(device, buffers[i]);
	device.next.FreeCommandBuffers(handle, pool, count, buffers);
}

VKAPI_ATTR VkResult VKAPI_CALL resetCommandPool(VkDevice handle, VkCommandPool pool, VkCommandPoolResetFlags flags)
{
	Device& device = deviceOf(handle);
	if (device.active)
		device.recordings.resetPool(device, pool);
	return device.next.ResetCommandPool(handle, pool, flags);
}

VKAPI_ATTR void VKAPI_CALL destroyCommandPool(VkDevice handle, VkCommandPool pool, const VkAllocationCallbacks* allocator)
{
	Device& device = deviceOf(handle);
	if (device.active)
		device.recordings.poolDestroyed(pool);
	device.next.DestroyCommandPool(handle, pool, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL beginCommandBuffer(VkCommandBuffer buffer, const VkCommandBufferBeginInfo* info)
{
	Device& device = deviceOf(buffer);
	if (device.active)
		device.recordings.began(device, buffer, *info);
	return device.next.BeginCommandBuffer(buffer, info);
}

VKAPI_ATTR VkResult VKAPI_CALL endCommandBuffer(VkCommandBuffer buffer)
{
	Device& device = deviceOf(buffer);
	const Recording* recording = device.active ? device.recordings.find(buffer) : nullptr;
	return device.next.EndCommandBuffer(recording ? recording->current : buffer);
}

VKAPI_ATTR VkResult VKAPI_CALL resetCommandBuffer(VkCommandBuffer buffer, VkCommandBufferResetFlags flags)
{
	Device& device = deviceOf(buffer);
	if (device.active)
		device.recordings.reset(device, buffer);
	return device.next.ResetCommandBuffer(buffer, flags);
}

}  // namespace tessera::layer
