#include "layer/memory.h"

#include "layer/device.h"

namespace tessera::layer
{

namespace
{

// The first type with all of `wanted`; what the device itself prefers comes first by Vulkan's rule of order.
uint32_t memoryType(const Device& device, uint32_t allowed, VkMemoryPropertyFlags wanted)
{
	for (uint32_t i = 0; i < device.memory.memoryTypeCount; ++i)
		if ((allowed >> i & 1u) && (device.memory.memoryTypes[i].propertyFlags & wanted) == wanted)
			return i;
	return UINT32_MAX;
}

}  // namespace

std::shared_ptr<OwnBuffer> OwnBuffer::make(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, bool host)
{
	std::shared_ptr<OwnBuffer> buffer(new OwnBuffer(device));
	return buffer->create(size ? size : 4, usage, host) ? buffer : nullptr;
}

bool OwnBuffer::create(VkDeviceSize size, VkBufferUsageFlags usage, bool host)
{
	size_ = size;
	VkBufferCreateInfo info = { VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO };
	info.size = size;
	info.usage = usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
	if (device_.next.CreateBuffer(device_.handle, &info, nullptr, &buffer_) != VK_SUCCESS)
		return false;
	VkMemoryRequirements needs = {};
	device_.next.GetBufferMemoryRequirements(device_.handle, buffer_, &needs);
	VkMemoryAllocateFlagsInfo flags = { VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO };
	flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
	VkMemoryAllocateInfo allocation = { VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags, needs.size };
	constexpr VkMemoryPropertyFlags kDevice = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
	constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
	allocation.memoryTypeIndex = memoryType(device_, needs.memoryTypeBits, host ? kHost : kDevice);
	if (allocation.memoryTypeIndex == UINT32_MAX || device_.next.AllocateMemory(device_.handle, &allocation, nullptr, &memory_) != VK_SUCCESS)
		return false;
	if (device_.next.BindBufferMemory(device_.handle, buffer_, memory_, 0) != VK_SUCCESS)
		return false;
	void* mapped = nullptr;
	if (host && device_.next.MapMemory(device_.handle, memory_, 0, VK_WHOLE_SIZE, 0, &mapped) != VK_SUCCESS)
		return false;
	data_ = static_cast<std::byte*>(mapped);
	const VkBufferDeviceAddressInfo of = { VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, buffer_ };
	address_ = device_.next.GetBufferDeviceAddress(device_.handle, &of);
	return true;
}

OwnBuffer::~OwnBuffer()
{
	device_.next.DestroyBuffer(device_.handle, buffer_, nullptr);
	device_.next.FreeMemory(device_.handle, memory_, nullptr);
}

}  // namespace tessera::layer
