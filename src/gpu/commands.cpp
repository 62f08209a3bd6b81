#include "gpu/commands.h"

#include "base/check.h"

#include <algorithm>
#include <cstring>

namespace tessera
{

Result<std::unique_ptr<CommandRecorder>> CommandRecorder::create(Device& device)
{
	std::unique_ptr<CommandRecorder> recorder(new CommandRecorder(device));
	VkCommandPoolCreateInfo pool = { VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO };
	pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
	pool.queueFamilyIndex = device.queue_family;
	VK_TRY(vkCreateCommandPool(device.handle, &pool, nullptr, &recorder->pool_), "creating the command pool");
	VkCommandBufferAllocateInfo allocate = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO };
	allocate.commandPool = recorder->pool_;
	allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
	allocate.commandBufferCount = 1;
	VK_TRY(vkAllocateCommandBuffers(device.handle, &allocate, &recorder->buffer_), "allocating the command buffer");
	VkFenceCreateInfo fence = { VK_STRUCTURE_TYPE_FENCE_CREATE_INFO };
	VK_TRY(vkCreateFence(device.handle, &fence, nullptr, &recorder->fence_), "creating the fence");
	return recorder;
}

CommandRecorder::~CommandRecorder()
{
	if (is_submitted_)
		vkWaitForFences(device_.handle, 1, &fence_, VK_TRUE, UINT64_MAX);
	vkDestroyFence(device_.handle, fence_, nullptr);
	vkDestroyCommandPool(device_.handle, pool_, nullptr);
}

Status CommandRecorder::begin()
{
	CHECK(!is_submitted_, "recording over commands that run");
	VkCommandBufferBeginInfo begin = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
	begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
	VK_TRY(vkBeginCommandBuffer(buffer_, &begin), "beginning commands");
	return {};
}

Status CommandRecorder::submit()
{
	VK_TRY(vkEndCommandBuffer(buffer_), "recording commands");
	VkCommandBufferSubmitInfo command = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO };
	command.commandBuffer = buffer_;
	VkSubmitInfo2 submit = { VK_STRUCTURE_TYPE_SUBMIT_INFO_2 };
	submit.commandBufferInfoCount = 1;
	submit.pCommandBufferInfos = &command;
	VK_TRY(vkQueueSubmit2(device_.queue, 1, &submit, fence_), "submitting commands");
	is_submitted_ = true;
	return {};
}

Result<bool> CommandRecorder::isFinished()
{
	if (!is_submitted_)
		return true;
	const VkResult status = vkGetFenceStatus(device_.handle, fence_);
	if (status == VK_NOT_READY)
		return false;
	VK_TRY(status, "asking whether the device is done");
	TRY(wait());
	return true;
}

Status CommandRecorder::wait()
{
	if (!is_submitted_)
		return {};
	VK_TRY(vkWaitForFences(device_.handle, 1, &fence_, VK_TRUE, UINT64_MAX), "waiting for the device");
	VK_TRY(vkResetFences(device_.handle, 1, &fence_), "resetting the fence");
	is_submitted_ = false;
	return {};
}

Status CommandRecorder::submitAndWait()
{
	TRY(submit());
	return wait();
}

void fullBarrier(VkCommandBuffer commands)
{
	VkMemoryBarrier2 barrier = { VK_STRUCTURE_TYPE_MEMORY_BARRIER_2 };
	barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
	barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
	barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
	barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT;
	VkDependencyInfo info = { VK_STRUCTURE_TYPE_DEPENDENCY_INFO };
	info.memoryBarrierCount = 1;
	info.pMemoryBarriers = &barrier;
	vkCmdPipelineBarrier2(commands, &info);
}

void toGeneralLayout(VkCommandBuffer commands, const ImageResource& image)
{
	VkImageMemoryBarrier2 barrier = { VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2 };
	barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
	barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
	barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
	barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
	barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
	barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
	barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
	barrier.image = image.handle();
	barrier.subresourceRange = { image.desc().aspect, 0, image.desc().levels, 0, 1 };
	VkDependencyInfo info = { VK_STRUCTURE_TYPE_DEPENDENCY_INFO };
	info.imageMemoryBarrierCount = 1;
	info.pImageMemoryBarriers = &barrier;
	vkCmdPipelineBarrier2(commands, &info);
}

Result<Buffer> uploadBuffer(Device& device, CommandRecorder& commands, std::span<const std::byte> bytes, const std::string& name,
							VkBufferUsageFlags more_usage)
{
	constexpr uint64_t kPieceBytes = uint64_t(64) << 20;
	TRY_ASSIGN(Buffer buffer, Buffer::create(device, bytes.size(), MemoryKind::Device, name, more_usage));
	if (bytes.empty())
		return buffer;
	TRY_ASSIGN(const Buffer staging, Buffer::create(device, std::min<uint64_t>(kPieceBytes, bytes.size()), MemoryKind::Upload, name + " staging"));
	for (uint64_t first = 0; first < bytes.size(); first += kPieceBytes)
	{
		const uint64_t count = std::min<uint64_t>(kPieceBytes, bytes.size() - first);
		std::memcpy(staging.mapped(), bytes.data() + first, count);
		staging.flushMapped();
		TRY(commands.begin());
		const VkBufferCopy copy = { 0, first, count };
		vkCmdCopyBuffer(commands.buffer(), staging.handle(), buffer.handle(), 1, &copy);
		fullBarrier(commands.buffer());
		TRY(commands.submitAndWait());
	}
	return buffer;
}

}  // namespace tessera
