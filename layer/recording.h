// A command buffer of the program as the layer records it: segments of the driver's commands, and between them commands that the host executes when
// the queue comes to them.
#pragma once
#include "layer/bound_state.h"
#include "layer/host_commands.h"

#include <mutex>
#include <optional>
#include <unordered_map>
#include <variant>
#include <vector>

namespace tessera::layer
{

struct Device;

using HostCommand = std::variant<ClusterCommand, TopLevelBuild, CopyOfStructure>;

// The driver's commands, and what the host does when they are done.
struct Step
{
	VkCommandBuffer segment;
	HostCommand command;
	uint32_t epoch = 0;  // how many barriers that order builds came before it
};

struct Recording
{
	VkCommandPool pool = VK_NULL_HANDLE;
	VkCommandBufferLevel level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
	VkCommandBufferUsageFlags flags = 0;
	VkCommandBuffer current = VK_NULL_HANDLE;  // the segment that commands go to; the first is the program's own handle
	std::vector<Step> steps;                   // finished segments
	BoundState state;
	int open = 0;  // render passes, queries and the like that have begun and not ended: no segment may end inside one
	std::string opened_by;
	uint32_t epoch = 0;
	bool traces_without_clusters = false;  // rays by a pipeline that was not made to meet clusters
};

class Recordings
{
public:
	void allocated(const VkCommandBufferAllocateInfo& info, const VkCommandBuffer* buffers);
	void began(Device& device, VkCommandBuffer buffer, const VkCommandBufferBeginInfo& info);
	void reset(Device& device, VkCommandBuffer buffer);
	void resetPool(Device& device, VkCommandPool pool);
	void freed(Device& device, VkCommandBuffer buffer);
	void poolDestroyed(VkCommandPool pool);
	// Null when it was allocated before the layer knew, which does not happen. Stays valid until freed.
	Recording* find(VkCommandBuffer buffer);

private:
	void dropSegments(Device& device, VkCommandBuffer buffer, Recording& recording);

	std::mutex lock_;
	std::unordered_map<VkCommandBuffer, Recording> all_;
};

// Ends the current segment: `command` runs on the host after it, and what follows is recorded into a new one.
void recordHostCommand(Device& device, VkCommandBuffer buffer, HostCommand command, const char* name);

VKAPI_ATTR VkResult VKAPI_CALL allocateCommandBuffers(VkDevice device, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* buffers);
VKAPI_ATTR void VKAPI_CALL freeCommandBuffers(VkDevice device, VkCommandPool pool, uint32_t count, const VkCommandBuffer* buffers);
VKAPI_ATTR VkResult VKAPI_CALL resetCommandPool(VkDevice device, VkCommandPool pool, VkCommandPoolResetFlags flags);
VKAPI_ATTR void VKAPI_CALL destroyCommandPool(VkDevice device, VkCommandPool pool, const VkAllocationCallbacks* allocator);
VKAPI_ATTR VkResult VKAPI_CALL beginCommandBuffer(VkCommandBuffer buffer, const VkCommandBufferBeginInfo* info);
VKAPI_ATTR VkResult VKAPI_CALL endCommandBuffer(VkCommandBuffer buffer);
VKAPI_ATTR VkResult VKAPI_CALL resetCommandBuffer(VkCommandBuffer buffer, VkCommandBufferResetFlags flags);
VKAPI_ATTR VkResult VKAPI_CALL queueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence);
VKAPI_ATTR VkResult VKAPI_CALL queueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence);
// The layer's entry of a recorded command; null when there is none of that name.
PFN_vkVoidFunction commandEntry(std::string_view name);

}  // namespace tessera::layer
