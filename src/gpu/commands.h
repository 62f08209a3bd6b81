// Command buffers: one-off work with a wait (uploads), and a frame's own buffer with its fence, which can be asked instead.
#pragma once
#include "gpu/resources.h"

#include <functional>

namespace tessera
{

class CommandRecorder
{
public:
	static Result<std::unique_ptr<CommandRecorder>> create(Device& device);
	~CommandRecorder();
	CommandRecorder(const CommandRecorder&) = delete;
	CommandRecorder& operator=(const CommandRecorder&) = delete;

	// Begins the one command buffer; what it held before must be finished.
	Status begin();
	VkCommandBuffer buffer() const { return buffer_; }
	// Ends and submits, without waiting. Errors: DeviceLost, as of those below.
	Status submit();
	// Whether the device is done with what was submitted last; never waits. True when nothing was.
	Result<bool> isFinished();
	Status wait();
	Status submitAndWait();

private:
	explicit CommandRecorder(Device& device) : device_(device) {}
	Device& device_;
	VkCommandPool pool_ = VK_NULL_HANDLE;
	VkCommandBuffer buffer_ = VK_NULL_HANDLE;
	VkFence fence_ = VK_NULL_HANDLE;
	bool is_submitted_ = false;
};

// Copies bytes into a new device-local buffer, in pieces through one staging buffer.
Result<Buffer> uploadBuffer(Device& device, CommandRecorder& commands, std::span<const std::byte> bytes, const std::string& name,
							VkBufferUsageFlags more_usage = 0);

// Orders everything before it before everything after it: for uploads and readbacks only.
void fullBarrier(VkCommandBuffer commands);
// From undefined to the layout every image stays in.
void toGeneralLayout(VkCommandBuffer commands, const ImageResource& image);

}  // namespace tessera
