// Buffers and images: move-only owners.
#pragma once
#include "gpu/allocator.h"
#include "gpu/device.h"

#include <span>

namespace tessera
{

// A buffer with a device address. Every buffer can be storage, indirect arguments, indices and a copy's source or target; where rays can be
// traced, also what acceleration structures are built from.
class Buffer
{
public:
	// bytes 1.. (0 is made 16); address aligned to 256. `more_usage`: beyond what every buffer can be used for.
	static Result<Buffer> create(Device& device, uint64_t bytes, MemoryKind kind, const std::string& name, VkBufferUsageFlags more_usage = 0);
	Buffer() = default;
	Buffer(Buffer&& other) noexcept { swap(other); }
	Buffer& operator=(Buffer&& other) noexcept
	{
		swap(other);
		return *this;
	}
	~Buffer();

	explicit operator bool() const { return allocation_.buffer; }
	VkBuffer handle() const { return allocation_.buffer; }
	uint64_t bytes() const { return bytes_; }
	uint64_t address() const { return address_; }
	std::byte* mapped() const { return static_cast<std::byte*>(allocation_.mapped); }
	void invalidateMapped() const { invalidate(device_->allocator, allocation_); }
	void flushMapped() const { flush(device_->allocator, allocation_); }

private:
	void swap(Buffer& other) noexcept;
	Device* device_ = nullptr;
	BufferAllocation allocation_;
	uint64_t bytes_ = 0, address_ = 0;
};

struct ImageDesc
{
	std::string name;
	VkFormat format = VK_FORMAT_UNDEFINED;
	uint32_t width = 1, height = 1, levels = 1;
	VkImageUsageFlags usage = 0;
	VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

class ImageResource
{
public:
	static Result<ImageResource> create(Device& device, const ImageDesc& desc);
	ImageResource() = default;
	ImageResource(ImageResource&& other) noexcept { swap(other); }
	ImageResource& operator=(ImageResource&& other) noexcept
	{
		swap(other);
		return *this;
	}
	~ImageResource();

	explicit operator bool() const { return allocation_.image; }
	VkImage handle() const { return allocation_.image; }
	VkImageView view() const { return view_; }
	const ImageDesc& desc() const { return desc_; }
	uint64_t bytes() const { return allocation_.bytes; }

private:
	void swap(ImageResource& other) noexcept;
	Device* device_ = nullptr;
	ImageAllocation allocation_;
	VkImageView view_ = VK_NULL_HANDLE;
	ImageDesc desc_;
};

}  // namespace tessera
