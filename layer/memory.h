// Buffers of the layer's own, made below it: the program's address map does not have them.
#pragma once
#include <vulkan/vulkan.h>

#include <cstddef>
#include <memory>

namespace tessera::layer
{

struct Device;

class OwnBuffer
{
public:
	// `host`: the host reads and writes it through data(). Null on failure (out of memory).
	static std::shared_ptr<OwnBuffer> make(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, bool host);
	~OwnBuffer();
	OwnBuffer(const OwnBuffer&) = delete;
	OwnBuffer& operator=(const OwnBuffer&) = delete;

	VkBuffer handle() const { return buffer_; }
	VkDeviceAddress address() const { return address_; }
	VkDeviceSize size() const { return size_; }
	std::byte* data() const { return data_; }

private:
	explicit OwnBuffer(Device& device) : device_(device) {}
	bool create(VkDeviceSize size, VkBufferUsageFlags usage, bool host);

	Device& device_;
	VkBuffer buffer_ = VK_NULL_HANDLE;
	VkDeviceMemory memory_ = VK_NULL_HANDLE;
	VkDeviceAddress address_ = 0;
	VkDeviceSize size_ = 0;
	std::byte* data_ = nullptr;
};

}  // namespace tessera::layer
