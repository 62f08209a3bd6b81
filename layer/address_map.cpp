#include "layer/address_map.h"

#include "layer/device.h"

#include <algorithm>

namespace tessera::layer
{

namespace
{

// What has an address is read and written by copies of the layer.
VkBufferCreateInfo withCopies(const VkBufferCreateInfo& info)
{
	VkBufferCreateInfo copied = info;
	if (info.usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT)
		copied.usage |= VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
	return copied;
}

}  // namespace

void AddressMap::created(VkBuffer buffer, VkDeviceSize size, VkBufferUsageFlags usage)
{
	const std::lock_guard guard(lock_);
	buffers_[buffer] = { size, usage, 0 };
}

void AddressMap::bound(Device& device, VkBuffer handle)
{
	const std::lock_guard guard(lock_);
	const auto found = buffers_.find(handle);
	if (found == buffers_.end() || !(found->second.usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT))
		return;
	const VkBufferDeviceAddressInfo info = { VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, handle };
	found->second.address = device.next.GetBufferDeviceAddress(device.handle, &info);
	by_address_.emplace(found->second.address, handle);
	largest_ = std::max(largest_, found->second.size);
}

std::pair<VkDeviceAddress, VkDeviceAddress> AddressMap::destroyed(VkBuffer handle)
{
	const std::lock_guard guard(lock_);
	const auto found = buffers_.find(handle);
	if (found == buffers_.end())
		return {};
	const Buffer buffer = found->second;
	buffers_.erase(found);
	const auto [first, last] = by_address_.equal_range(buffer.address);
	for (auto entry = first; entry != last; ++entry)
		if (entry->second == handle)
		{
			by_address_.erase(entry);
			return { buffer.address, buffer.address + buffer.size };
		}
	return {};
}

std::optional<Place> AddressMap::find(VkDeviceAddress address, VkDeviceSize size, VkBufferUsageFlags usage) const
{
	const std::lock_guard guard(lock_);
	std::optional<Place> best;
	for (auto entry = by_address_.upper_bound(address); entry != by_address_.begin();)
	{
		--entry;
		const VkDeviceSize offset = address - entry->first;
		if (offset >= largest_)
			break;
		const Buffer& buffer = buffers_.at(entry->second);
		if (offset > buffer.size || size > buffer.size - offset)
			continue;
		best = Place{ entry->second, offset, buffer.usage };
		if ((buffer.usage & usage) == usage)
			return best;
	}
	return best;
}

VKAPI_ATTR VkResult VKAPI_CALL createBuffer(VkDevice handle, const VkBufferCreateInfo* info, const VkAllocationCallbacks* allocator, VkBuffer* buffer)
{
	Device& device = deviceOf(handle);
	if (!device.active)
		return device.next.CreateBuffer(handle, info, allocator, buffer);
	const VkBufferCreateInfo changed = withCopies(*info);
	const VkResult result = device.next.CreateBuffer(handle, &changed, allocator, buffer);
	if (result == VK_SUCCESS)
		device.addresses.created(*buffer, info->size, info->usage);
	return result;
}

VKAPI_ATTR void VKAPI_CALL destroyBuffer(VkDevice handle, VkBuffer buffer, const VkAllocationCallbacks* allocator)
{
	Device& device = deviceOf(handle);
	if (device.active && buffer)
	{
		const auto [first, end] = device.addresses.destroyed(buffer);
		device.structures.memoryEnded(device, first, end);
	}
	device.next.DestroyBuffer(handle, buffer, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL bindBufferMemory(VkDevice handle, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset)
{
	Device& device = deviceOf(handle);
	const VkResult result = device.next.BindBufferMemory(handle, buffer, memory, offset);
	if (device.active && result == VK_SUCCESS)
		device.addresses.bound(device, buffer);
	return result;
}

VKAPI_ATTR VkResult VKAPI_CALL bindBufferMemory2(VkDevice handle, uint32_t count, const VkBindBufferMemoryInfo* infos)
{
	Device& device = deviceOf(handle);
	const VkResult result = device.next.BindBufferMemory2(handle, count, infos);
	if (device.active && result == VK_SUCCESS)
		for (uint32_t i = 0; i < count; ++i)
			device.addresses.bound(device, infos[i].buffer);
	return result;
}

VKAPI_ATTR void VKAPI_CALL getDeviceBufferMemoryRequirements(VkDevice handle, const VkDeviceBufferMemoryRequirements* info,
															 VkMemoryRequirements2* requirements)
{
	Device& device = deviceOf(handle);
	const VkBufferCreateInfo changed = device.active ? withCopies(*info->pCreateInfo) : *info->pCreateInfo;
	VkDeviceBufferMemoryRequirements same_buffer = *info;
	same_buffer.pCreateInfo = &changed;
	device.next.GetDeviceBufferMemoryRequirements(handle, &same_buffer, requirements);
}

}  // namespace tessera::layer
