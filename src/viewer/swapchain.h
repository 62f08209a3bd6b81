// The images that the window shows, and the render pass in which the user interface is drawn over them.
#pragma once
#include "base/vec.h"
#include "gpu/device.h"

#include <optional>

namespace tessera::view
{

class Swapchain
{
public:
	// Takes the surface. Errors: DeviceCannot when the device cannot copy pictures to it or has no format of 8 bits.
	static Result<std::unique_ptr<Swapchain>> create(Device& device, VkSurfaceKHR surface, uvec2 size_px, bool vsync);
	~Swapchain();
	Swapchain(const Swapchain&) = delete;
	Swapchain& operator=(const Swapchain&) = delete;

	// Makes the images anew; nothing may be in flight. A size of 0 leaves none.
	Status resize(uvec2 size_px, bool vsync);

	// The next image; nothing when the window has changed and resize is needed.
	Result<std::optional<uint32_t>> acquire(VkSemaphore signal);
	// True when the window has changed.
	Result<bool> present(uint32_t image, VkSemaphore wait);

	uvec2 sizePx() const { return size_px_; }
	bool isVsync() const { return vsync_; }
	// Vsync cannot be switched off everywhere.
	bool canSwitchVsync() const { return can_switch_vsync_; }
	uint32_t imageCount() const { return static_cast<uint32_t>(images_.size()); }
	VkImage image(uint32_t index) const { return images_[index].image; }
	VkFramebuffer framebuffer(uint32_t index) const { return images_[index].framebuffer; }
	VkSemaphore drawn(uint32_t index) const { return images_[index].drawn; }
	VkRenderPass renderPass() const { return render_pass_; }

private:
	struct Image
	{
		VkImage image = VK_NULL_HANDLE;
		VkImageView view = VK_NULL_HANDLE;
		VkFramebuffer framebuffer = VK_NULL_HANDLE;
		VkSemaphore drawn = VK_NULL_HANDLE;  // presenting waits for it; per image, since only showing it again tells that it was waited for
	};
	Swapchain(Device& device, VkSurfaceKHR surface) : device_(device), surface_(surface) {}
	Status chooseFormat();
	Status makeRenderPass();
	Status makeImages();
	void destroyImages();

	Device& device_;
	VkSurfaceKHR surface_ = VK_NULL_HANDLE;
	VkSurfaceFormatKHR format_ = {};
	VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
	VkRenderPass render_pass_ = VK_NULL_HANDLE;
	std::vector<Image> images_;
	uvec2 size_px_ = { 0, 0 };
	bool vsync_ = true, can_switch_vsync_ = false;
};

}  // namespace tessera::view
