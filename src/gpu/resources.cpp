#include "gpu/resources.h"

#include <algorithm>
#include <utility>

namespace tessera
{

Result<Buffer> Buffer::create(Device& device, uint64_t bytes, MemoryKind kind, const std::string& name, VkBufferUsageFlags more_usage)
{
	VkBufferCreateInfo info = { VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO };
	info.size = std::max<uint64_t>(16, (bytes + 15) / 16 * 16);
	if (info.size > device.limits.max_buffer_bytes)
		return badInput("{}: {} bytes are too many for one buffer, {} can have {}; a smaller scene, --size, --budget or a coarser --rate is right",
						name, info.size, device.name, device.limits.max_buffer_bytes);
	info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
				 VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
				 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | more_usage;
	if (device.gates.rays())
		info.usage |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
	Buffer buffer;
	TRY_ASSIGN(buffer.allocation_, allocateBuffer(device.allocator, info, kind, name));
	buffer.device_ = &device;
	buffer.bytes_ = info.size;
	VkBufferDeviceAddressInfo address = { VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO };
	address.buffer = buffer.handle();
	buffer.address_ = vkGetBufferDeviceAddress(device.handle, &address);
	device.nameObject(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(buffer.handle()), name);
	return buffer;
}

Buffer::~Buffer()
{
	if (allocation_.buffer)
		freeBuffer(device_->allocator, allocation_);
}

void Buffer::swap(Buffer& other) noexcept
{
	std::swap(device_, other.device_);
	std::swap(allocation_, other.allocation_);
	std::swap(bytes_, other.bytes_);
	std::swap(address_, other.address_);
}

Result<ImageResource> ImageResource::create(Device& device, const ImageDesc& desc)
{
	VkImageCreateInfo info = { VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO };
	info.imageType = VK_IMAGE_TYPE_2D;
	info.format = desc.format;
	info.extent = { desc.width, desc.height, 1 };
	info.mipLevels = desc.levels;
	info.arrayLayers = 1;
	info.samples = VK_SAMPLE_COUNT_1_BIT;
	info.usage = desc.usage;
	ImageResource image;
	TRY_ASSIGN(image.allocation_, allocateImage(device.allocator, info, desc.name));
	image.device_ = &device;
	image.desc_ = desc;
	VkImageViewCreateInfo view = { VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO };
	view.image = image.handle();
	view.viewType = VK_IMAGE_VIEW_TYPE_2D;
	view.format = desc.format;
	view.subresourceRange = { desc.aspect, 0, desc.levels, 0, 1 };
	VK_TRY(vkCreateImageView(device.handle, &view, nullptr, &image.view_), "creating a view of image {}", desc.name);
	device.nameObject(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(image.handle()), desc.name);
	return image;
}

ImageResource::~ImageResource()
{
	if (view_)
		vkDestroyImageView(device_->handle, view_, nullptr);
	if (allocation_.image)
		freeImage(device_->allocator, allocation_);
}

void ImageResource::swap(ImageResource& other) noexcept
{
	std::swap(device_, other.device_);
	std::swap(allocation_, other.allocation_);
	std::swap(view_, other.view_);
	std::swap(desc_, other.desc_);
}

}  // namespace tessera
