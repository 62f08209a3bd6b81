// Device memory, through the Vulkan Memory Allocator.
#pragma once
#include "gpu/vulkan.h"

struct VmaAllocator_T;
struct VmaAllocation_T;

namespace tessera
{

class Device;

Result<VmaAllocator_T*> createAllocator(const Device& device);
void destroyAllocator(VmaAllocator_T* allocator);

enum class MemoryKind
{
	Device,    // GPU only
	Upload,    // written by the host in sequence, read by the GPU
	Readback,  // written by the GPU, read by the host
};

struct BufferAllocation
{
	VkBuffer buffer = VK_NULL_HANDLE;
	VmaAllocation_T* allocation = nullptr;
	void* mapped = nullptr;
};
struct ImageAllocation
{
	VkImage image = VK_NULL_HANDLE;
	VmaAllocation_T* allocation = nullptr;
	uint64_t bytes = 0;
};

Result<BufferAllocation> allocateBuffer(VmaAllocator_T* allocator, const VkBufferCreateInfo& info, MemoryKind kind, const std::string& name);
Result<ImageAllocation> allocateImage(VmaAllocator_T* allocator, const VkImageCreateInfo& info, const std::string& name);
void freeBuffer(VmaAllocator_T* allocator, const BufferAllocation& allocation);
void freeImage(VmaAllocator_T* allocator, const ImageAllocation& allocation);
void invalidate(VmaAllocator_T* allocator, const BufferAllocation& allocation);
void flush(VmaAllocator_T* allocator, const BufferAllocation& allocation);

}  // namespace tessera
