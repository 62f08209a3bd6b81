// Which live buffer a device address lies in. Every buffer that can have an address is known from its memory being bound on.
#pragma once
#include <vulkan/vulkan.h>

#include <map>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

namespace tessera::layer
{

struct Device;

// A range of bytes in a live buffer.
struct Place
{
	VkBuffer buffer = VK_NULL_HANDLE;
	VkDeviceSize offset = 0;
	VkBufferUsageFlags usage = 0;
};

class AddressMap
{
public:
	void created(VkBuffer buffer, VkDeviceSize size, VkBufferUsageFlags usage);
	// Its address is asked for here: a program may learn an address and use it without the layer seeing how.
	void bound(Device& device, VkBuffer buffer);
	// Returns the addresses that end with it, [first, second); empty when it had none.
	std::pair<VkDeviceAddress, VkDeviceAddress> destroyed(VkBuffer buffer);
	// The buffer in which [address, address + size) lies whole; of several on the same memory, one with all of `usage`, if there is one.
	std::optional<Place> find(VkDeviceAddress address, VkDeviceSize size, VkBufferUsageFlags usage) const;

private:
	struct Buffer
	{
		VkDeviceSize size = 0;
		VkBufferUsageFlags usage = 0;
		VkDeviceAddress address = 0;
	};

	mutable std::mutex lock_;
	std::unordered_map<VkBuffer, Buffer> buffers_;
	std::multimap<VkDeviceAddress, VkBuffer> by_address_;
	VkDeviceSize largest_ = 0;
};

VKAPI_ATTR VkResult VKAPI_CALL createBuffer(VkDevice device, const VkBufferCreateInfo* info, const VkAllocationCallbacks* allocator,
											VkBuffer* buffer);
VKAPI_ATTR void VKAPI_CALL destroyBuffer(VkDevice device, VkBuffer buffer, const VkAllocationCallbacks* allocator);
VKAPI_ATTR VkResult VKAPI_CALL bindBufferMemory(VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset);
VKAPI_ATTR VkResult VKAPI_CALL bindBufferMemory2(VkDevice device, uint32_t count, const VkBindBufferMemoryInfo* infos);
VKAPI_ATTR void VKAPI_CALL getDeviceBufferMemoryRequirements(VkDevice device, const VkDeviceBufferMemoryRequirements* info,
															 VkMemoryRequirements2* requirements);

}  // namespace tessera::layer
