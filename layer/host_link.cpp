#include "layer/host_link.h"

#include "layer/device.h"

#include <algorithm>
#include <map>

namespace tessera::layer
{

namespace
{

void barrier(const Device& device, VkCommandBuffer commands)
{
	VkMemoryBarrier all = { VK_STRUCTURE_TYPE_MEMORY_BARRIER };
	all.srcAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
	all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_HOST_READ_BIT;
	device.next.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0,
								   1, &all, 0, nullptr, 0, nullptr);
}

// Copy regions of pieces, by the program's buffer. Their place in the staging buffer is `at` of each.
std::map<VkBuffer, std::vector<VkBufferCopy>> regionsOf(std::span<const Piece> pieces, bool read)
{
	std::map<VkBuffer, std::vector<VkBufferCopy>> regions;
	for (const Piece& piece : pieces)
		if (piece.size)
			regions[piece.place.buffer].push_back(read ? VkBufferCopy{ piece.place.offset, piece.at, piece.size }
													   : VkBufferCopy{ piece.at, piece.place.offset, piece.size });
	return regions;
}

}  // namespace

size_t Reads::add(const Place& place, VkDeviceSize size)
{
	pieces_.push_back({ place, size_t(size), total_ });
	total_ += size;
	return pieces_.size() - 1;
}

void Writes::add(const Place& place, std::span<const std::byte> bytes)
{
	pieces_.push_back({ place, bytes.size(), bytes_.size() });
	bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

HostLink::HostLink(Device& device, uint32_t family) : device_(device)
{
	VkCommandPoolCreateInfo pool = { VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO };
	pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
	pool.queueFamilyIndex = family;
	device.next.CreateCommandPool(device.handle, &pool, nullptr, &pool_);
	VkCommandBufferAllocateInfo allocation = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO };
	allocation.commandPool = pool_;
	allocation.commandBufferCount = 1;
	if (device.next.AllocateCommandBuffers(device.handle, &allocation, &commands_) == VK_SUCCESS && device.set_loader_data)
		device.set_loader_data(device.handle, commands_);
	const VkFenceCreateInfo fence = { VK_STRUCTURE_TYPE_FENCE_CREATE_INFO };
	device.next.CreateFence(device.handle, &fence, nullptr, &fence_);
}

HostLink::~HostLink()
{
	device_.next.DestroyFence(device_.handle, fence_, nullptr);
	device_.next.DestroyCommandPool(device_.handle, pool_, nullptr);
}

VkResult HostLink::submitAndWait(VkQueue queue, VkCommandBuffer commands)
{
	VkSubmitInfo submit = { VK_STRUCTURE_TYPE_SUBMIT_INFO };
	submit.commandBufferCount = commands ? 1 : 0;
	submit.pCommandBuffers = &commands;
	VkResult result = device_.next.QueueSubmit(queue, 1, &submit, fence_);
	if (result == VK_SUCCESS)
		result = device_.next.WaitForFences(device_.handle, 1, &fence_, VK_TRUE, UINT64_MAX);
	if (result == VK_SUCCESS)
		result = device_.next.ResetFences(device_.handle, 1, &fence_);
	return result;
}

VkResult HostLink::run(VkQueue queue, const std::function<void(VkCommandBuffer)>& record)
{
	VkCommandBufferBeginInfo begin = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
	begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
	if (const VkResult result = device_.next.BeginCommandBuffer(commands_, &begin); result != VK_SUCCESS)
		return result;
	barrier(device_, commands_);
	record(commands_);
	barrier(device_, commands_);
	if (const VkResult result = device_.next.EndCommandBuffer(commands_); result != VK_SUCCESS)
		return result;
	return submitAndWait(queue, commands_);
}

bool HostLink::reserveStaging(VkDeviceSize size)
{
	if (!staging_ || staging_->size() < size)
		staging_ = OwnBuffer::make(device_, std::max<VkDeviceSize>(size + size / 2, 1 << 16), 0, true);
	return staging_ != nullptr;
}

VkResult HostLink::read(VkQueue queue, Reads& reads)
{
	reads.bytes_.resize(reads.total_);
	if (reads.total_ == 0)
		return VK_SUCCESS;
	if (!reserveStaging(reads.total_))
		return VK_ERROR_OUT_OF_DEVICE_MEMORY;
	const VkResult result = run(queue, [&](VkCommandBuffer commands) {
		for (const auto& [buffer, regions] : regionsOf(reads.pieces_, true))
			device_.next.CmdCopyBuffer(commands, buffer, staging_->handle(), static_cast<uint32_t>(regions.size()), regions.data());
	});
	if (result == VK_SUCCESS)
		std::memcpy(reads.bytes_.data(), staging_->data(), reads.total_);
	return result;
}

VkResult HostLink::write(VkQueue queue, const Writes& writes)
{
	if (writes.bytes_.empty())
		return VK_SUCCESS;
	if (!reserveStaging(writes.bytes_.size()))
		return VK_ERROR_OUT_OF_DEVICE_MEMORY;
	std::memcpy(staging_->data(), writes.bytes_.data(), writes.bytes_.size());
	return run(queue, [&](VkCommandBuffer commands) {
		for (const auto& [buffer, regions] : regionsOf(writes.pieces_, false))
			device_.next.CmdCopyBuffer(commands, staging_->handle(), buffer, static_cast<uint32_t>(regions.size()), regions.data());
	});
}

}  // namespace tessera::layer
