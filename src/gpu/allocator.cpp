#include "gpu/allocator.h"

#include "gpu/device.h"

// Warnings inside the allocator's own header are not ours.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-variable"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wimplicit-fallthrough"
#define VMA_IMPLEMENTATION
#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#define VMA_VULKAN_VERSION 1003000
#include <vk_mem_alloc.h>
#pragma GCC diagnostic pop

namespace tessera
{

Result<VmaAllocator_T*> createAllocator(const Device& device)
{
	VmaVulkanFunctions functions = {};
	functions.vkGetInstanceProcAddr = vkGetInstanceProcAddr;
	functions.vkGetDeviceProcAddr = vkGetDeviceProcAddr;
	VmaAllocatorCreateInfo info = {};
	info.flags = VMA_ALLOCATOR_CREATE_BUFFER_DEVICE_ADDRESS_BIT;
	info.physicalDevice = device.physical;
	info.device = device.handle;
	info.instance = device.instance;
	info.pVulkanFunctions = &functions;
	info.vulkanApiVersion = VK_API_VERSION_1_3;
	VmaAllocator allocator = nullptr;
	VK_TRY(vmaCreateAllocator(&info, &allocator), "creating the memory allocator");
	return allocator;
}

void destroyAllocator(VmaAllocator_T* allocator)
{
	vmaDestroyAllocator(allocator);
}

static VmaAllocationCreateInfo allocationInfo(MemoryKind kind)
{
	VmaAllocationCreateInfo info = {};
	info.usage = VMA_MEMORY_USAGE_AUTO;
	if (kind == MemoryKind::Device)
		info.usage = VMA_MEMORY_USAGE_AUTO_PREFER_DEVICE;
	if (kind == MemoryKind::Upload)
		info.flags = VMA_ALLOCATION_CREATE_HOST_ACCESS_SEQUENTIAL_WRITE_BIT | VMA_ALLOCATION_CREATE_MAPPED_BIT;
	if (kind == MemoryKind::Readback)
		info.flags = VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT | VMA_ALLOCATION_CREATE_MAPPED_BIT;
	return info;
}

Result<BufferAllocation> allocateBuffer(VmaAllocator_T* allocator, const VkBufferCreateInfo& info, MemoryKind kind, const std::string& name)
{
	const VmaAllocationCreateInfo how = allocationInfo(kind);
	BufferAllocation result;
	VmaAllocationInfo details = {};
	VK_TRY(vmaCreateBufferWithAlignment(allocator, &info, &how, 256, &result.buffer, &result.allocation, &details), "allocating {} bytes for {}",
		   info.size, name);
	result.mapped = details.pMappedData;
	return result;
}

Result<ImageAllocation> allocateImage(VmaAllocator_T* allocator, const VkImageCreateInfo& info, const std::string& name)
{
	const VmaAllocationCreateInfo how = allocationInfo(MemoryKind::Device);
	ImageAllocation result;
	VmaAllocationInfo details = {};
	VK_TRY(vmaCreateImage(allocator, &info, &how, &result.image, &result.allocation, &details), "allocating image {} ({} x {})", name,
		   info.extent.width, info.extent.height);
	result.bytes = details.size;
	return result;
}

void freeBuffer(VmaAllocator_T* allocator, const BufferAllocation& allocation)
{
	vmaDestroyBuffer(allocator, allocation.buffer, allocation.allocation);
}

void freeImage(VmaAllocator_T* allocator, const ImageAllocation& allocation)
{
	vmaDestroyImage(allocator, allocation.image, allocation.allocation);
}

void invalidate(VmaAllocator_T* allocator, const BufferAllocation& allocation)
{
	vmaInvalidateAllocation(allocator, allocation.allocation, 0, VK_WHOLE_SIZE);
}

void flush(VmaAllocator_T* allocator, const BufferAllocation& allocation)
{
	vmaFlushAllocation(allocator, allocation.allocation, 0, VK_WHOLE_SIZE);
}

}  // namespace tessera
