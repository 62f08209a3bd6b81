#include "viewer/window.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <utility>

namespace tessera::view
{

namespace
{

std::string lastGlfwError()
{
	const char* text = nullptr;
	glfwGetError(&text);
	return text ? text : "unknown error";
}

Window& windowOf(GLFWwindow* window)
{
	return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(uint32_t width_px, uint32_t height_px, bool full_screen)
{
	if (!glfwInit())
		return fail(ExitCode::DeviceCannot, "view: no window can be opened: {}; `tessera render` needs no display", lastGlfwError());
	std::unique_ptr<Window> window(new Window);
	if (!glfwVulkanSupported())
		return fail(ExitCode::DeviceCannot, "view: {}; a Vulkan driver is needed", lastGlfwError());
	glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
	GLFWwindow* handle = glfwCreateWindow(static_cast<int>(width_px), static_cast<int>(height_px), "tessera", nullptr, nullptr);
	if (!handle)
		return fail(ExitCode::DeviceCannot, "view: opening a window: {}", lastGlfwError());
	window->window_ = handle;
	glfwSetWindowUserPointer(handle, window.get());
	glfwSetKeyCallback(handle, onKey);
	glfwSetScrollCallback(handle, onScroll);
	glfwSetDropCallback(handle, onDrop);
	glfwSetCursorPosCallback(handle, [](GLFWwindow* w, double, double) { onChange(w); });
	glfwSetMouseButtonCallback(handle, [](GLFWwindow* w, int, int, int) { onChange(w); });
	glfwSetCharCallback(handle, [](GLFWwindow* w, unsigned) { onChange(w); });
	glfwSetFramebufferSizeCallback(handle, [](GLFWwindow* w, int, int) { onChange(w); });
	if (full_screen)
		window->setFullScreen(true);
	return window;
}

Window::~Window()
{
	if (window_)
		glfwDestroyWindow(window_);
	glfwTerminate();
}

void Window::addTo(DeviceRequest& request) const
{
	uint32_t count = 0;
	const char** names = glfwGetRequiredInstanceExtensions(&count);
	request.instance_extensions.assign(names, names + count);
	request.can_present = [](VkInstance instance, VkPhysicalDevice physical, uint32_t family) {
		return glfwGetPhysicalDevicePresentationSupport(instance, physical, family) == GLFW_TRUE;
	};
}

Result<VkSurfaceKHR> Window::makeSurface(VkInstance instance) const
{
	VkSurfaceKHR surface = VK_NULL_HANDLE;
	VK_TRY(glfwCreateWindowSurface(instance, window_, nullptr, &surface), "view: making the window's surface");
	return surface;
}

WindowEvents Window::poll(double wait_s)
{
	if (wait_s > 0)
		glfwWaitEventsTimeout(wait_s);
	else
		glfwPollEvents();
	return std::exchange(events_, {});
}

bool Window::wantsClose() const
{
	return glfwWindowShouldClose(window_) != 0;
}

void Window::close()
{
	glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

uvec2 Window::sizePx() const
{
	int width = 0, height = 0;
	glfwGetFramebufferSize(window_, &width, &height);
	if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED))
		return { 0, 0 };
	return { static_cast<uint32_t>(width), static_cast<uint32_t>(height) };
}

dvec2 Window::mousePx() const
{
	double x = 0, y = 0;
	int width = 1, height = 1;
	glfwGetCursorPos(window_, &x, &y);
	glfwGetWindowSize(window_, &width, &height);
	const uvec2 size = sizePx();
	return { width > 0 ? x * size.x / width : 0, height > 0 ? y * size.y / height : 0 };
}

bool Window::isButtonDown(int button) const
{
	return glfwGetMouseButton(window_, button) == GLFW_PRESS;
}

bool Window::isKeyDown(int key) const
{
	return glfwGetKey(window_, key) == GLFW_PRESS;
}

bool Window::isFullScreen() const
{
	return glfwGetWindowMonitor(window_) != nullptr;
}

void Window::setFullScreen(bool on)
{
	if (on == isFullScreen())
		return;
	if (!on)
	{
		glfwSetWindowMonitor(window_, nullptr, windowed_[0], windowed_[1], windowed_[2], windowed_[3], GLFW_DONT_CARE);
		return;
	}
	GLFWmonitor* monitor = glfwGetPrimaryMonitor();
	const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
	if (!mode)
		return;
	glfwGetWindowPos(window_, &windowed_[0], &windowed_[1]);
	glfwGetWindowSize(window_, &windowed_[2], &windowed_[3]);
	glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::setTitle(const std::string& title)
{
	glfwSetWindowTitle(window_, title.c_str());
}

void Window::setClipboard(const std::string& text)
{
	glfwSetClipboardString(window_, text.c_str());
}

float Window::contentScale() const
{
	float x = 1, y = 1;
	glfwGetWindowContentScale(window_, &x, &y);
	return y > 0 ? y : 1;
}

void Window::onKey(GLFWwindow* window, int key, int, int action, int modifiers)
{
	onChange(window);
	if (action != GLFW_RELEASE)
		windowOf(window).events_.keys.push_back({ key, (modifiers & GLFW_MOD_SHIFT) != 0, (modifiers & GLFW_MOD_CONTROL) != 0 });
}

void Window::onScroll(GLFWwindow* window, double, double y)
{
	onChange(window);
	windowOf(window).events_.scrolled += y;
}

void Window::onDrop(GLFWwindow* window, int count, const char** paths)
{
	onChange(window);
	for (int i = 0; i < count; ++i)
		windowOf(window).events_.dropped.emplace_back(paths[i]);
}

void Window::onChange(GLFWwindow* window)
{
	windowOf(window).events_.any = true;
}

}  // namespace tessera::view
