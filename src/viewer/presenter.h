// Draws the window: the picture of the scene, the user interface over it; two frames in flight.
#pragma once
#include "gpu/commands.h"
#include "viewer/swapchain.h"
#include "viewer/window.h"

struct ImDrawData;

namespace tessera::view
{

// A picture of the scene that is finished: RGBA, 8 bits each, rows top to bottom.
struct ScenePicture
{
	VkBuffer buffer = VK_NULL_HANDLE;
	uvec2 size_px = { 0, 0 };
};

class Presenter
{
public:
	// Begins ImGui's back ends; an ImGui context must exist and outlive it.
	static Result<std::unique_ptr<Presenter>> create(Device& device, Window& window, bool vsync);
	~Presenter();
	Presenter(const Presenter&) = delete;
	Presenter& operator=(const Presenter&) = delete;

	// Draws and shows a frame. `picture`: a new one, which is copied before anything that is submitted later; the last one is shown until then.
	// `place_px`: where its upper left corner lies in the window. `interface`: ImGui's, or nullptr. True when a frame was shown; false when the
	// window has no size. Waits for the frame before the last, never for one of the scene. Errors: DeviceLost.
	Result<bool> draw(const std::optional<ScenePicture>& picture, ivec2 place_px, ImDrawData* interface);

	// Waits for the frames of the window: what they read may be let go then.
	Status wait();

	void setVsync(bool on) { vsync_ = on; }
	bool isVsync() const { return vsync_; }
	bool canSwitchVsync() const { return swapchain_->canSwitchVsync(); }
	uvec2 sizePx() const { return swapchain_->sizePx(); }

private:
	struct Slot
	{
		VkCommandPool pool = VK_NULL_HANDLE;
		VkCommandBuffer commands = VK_NULL_HANDLE;
		VkFence finished = VK_NULL_HANDLE;
		VkSemaphore acquired = VK_NULL_HANDLE;
	};
	Presenter(Device& device, Window& window) : device_(device), window_(window) {}
	Status makeSlots();
	Status startInterface();
	Status fitSwapchain();
	Status takePicture(VkCommandBuffer commands, const ScenePicture& picture);
	Status record(VkCommandBuffer commands, uint32_t image, const std::optional<ScenePicture>& picture, ivec2 place_px, ImDrawData* interface);
	void copyToWindow(VkCommandBuffer commands, VkImage target, ivec2 place_px) const;
	void drawInterface(VkCommandBuffer commands, uint32_t image, ImDrawData* interface) const;

	Device& device_;
	Window& window_;
	std::unique_ptr<Swapchain> swapchain_;
	std::unique_ptr<CommandRecorder> once_;
	std::array<Slot, 2> slots_;
	size_t slot_ = 0;
	VkDescriptorPool interface_pool_ = VK_NULL_HANDLE;
	bool has_interface_ = false;
	ImageResource picture_;
	bool vsync_ = true, is_stale_ = false;
};

}  // namespace tessera::view
