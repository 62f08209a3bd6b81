// The window: GLFW, what it needs of Vulkan, and what the user did in it since it was last asked.
#pragma once
#include "base/vec.h"
#include "gpu/device.h"

#include <string>
#include <vector>

struct GLFWwindow;

namespace tessera::view
{

// A key or button that was pressed, as it came; the user interface sees them too.
struct KeyPress
{
	int key = 0;  // GLFW_KEY_*
	bool shift = false, control = false;
};

struct WindowEvents
{
	std::vector<KeyPress> keys;
	std::vector<std::string> dropped;  // paths of files
	double scrolled = 0;
	bool any = false;
};

class Window
{
public:
	// Errors: DeviceCannot (no display, no Vulkan), one line that says what to do.
	static Result<std::unique_ptr<Window>> create(uint32_t width_px, uint32_t height_px, bool full_screen);
	~Window();
	Window(const Window&) = delete;
	Window& operator=(const Window&) = delete;

	// What a device needs to draw into this window.
	void addTo(DeviceRequest& request) const;
	Result<VkSurfaceKHR> makeSurface(VkInstance instance) const;

	// Takes what has happened; waits for it at most `wait_s`.
	WindowEvents poll(double wait_s);
	bool wantsClose() const;
	void close();
	// Pixels to draw; 0 while minimised.
	uvec2 sizePx() const;
	// Where the mouse is, in pixels from the top left.
	dvec2 mousePx() const;
	bool isButtonDown(int button) const;
	bool isKeyDown(int key) const;
	bool isFullScreen() const;
	void setFullScreen(bool on);
	void setTitle(const std::string& title);
	void setClipboard(const std::string& text);
	// Pixels per unit of the desktop's coordinates: above 1 on dense displays.
	float contentScale() const;
	GLFWwindow* handle() const { return window_; }

private:
	Window() = default;
	static void onKey(GLFWwindow* window, int key, int code, int action, int modifiers);
	static void onScroll(GLFWwindow* window, double x, double y);
	static void onDrop(GLFWwindow* window, int count, const char** paths);
	static void onChange(GLFWwindow* window);

	GLFWwindow* window_ = nullptr;
	WindowEvents events_;
	int windowed_[4] = { 100, 100, 1280, 720 };  // place and size to go back to from full screen
};

}  // namespace tessera::view
