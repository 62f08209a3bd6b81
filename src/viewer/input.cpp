#include "viewer/input.h"

#include "viewer/camera_control.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace tessera::view
{

namespace
{

constexpr double kRadPerPx = 0.006;
constexpr double kClickPx = 4, kDoubleClick_s = 0.35;
constexpr float kRateStep = 1.189207115f;  // a quarter of a doubling
constexpr float kFinestRate = 0.05f, kCoarsestRate = 1000;

constexpr std::string_view kHelp[] = {
	"left drag: orbit",
	"right or middle drag: pan",
	"Ctrl + left drag: look around",
	"wheel: nearer, farther",
	"W A S D, E C: fly, up, down",
	"F: frame what was picked, or the scene",
	"Home: back to the first view",
	"+ -: tessellation rate",
	"Ctrl+O: open a scene",
	"Ctrl+C: copy the render command",
	"Q: debug camera on and off",
	"Shift: moves what it culls for",
	"click: inspect a pixel",
	"double click: turn around it",
	"V: vertical sync",
	"R: reload shaders",
	"F1: panels on and off",
	"F9: write --ui-state",
	"F11: full screen",
	"F12: screenshot",
	"Ctrl+Q: quit",
};

bool isOverPicture(dvec2 mouse_px, const Session& session)
{
	const dvec2 low = dvec2(session.viewport_low), high = low + dvec2(session.viewport_size);
	return mouse_px.x >= low.x && mouse_px.y >= low.y && mouse_px.x < high.x && mouse_px.y < high.y && !ImGui::GetIO().WantCaptureMouse;
}

// With Shift the debug camera, else the one that the picture is drawn from.
Camera& movedCamera(const Window& window, Session& session)
{
	const bool shift = window.isKeyDown(GLFW_KEY_LEFT_SHIFT) || window.isKeyDown(GLFW_KEY_RIGHT_SHIFT);
	return session.debug_camera && shift ? session.culled_camera : session.camera;
}

uvec2 pictureXy(dvec2 mouse_px, const Session& session)
{
	return uvec2(glm::max(mouse_px - dvec2(session.viewport_low), dvec2(0)));
}

void changeRate(Session& session, float factor)
{
	float& rate = session.options.rate;
	if (rate > 0)
		rate = std::clamp(rate * factor, kFinestRate, kCoarsestRate);
}

}  // namespace

std::span<const std::string_view> keyHelp()
{
	return kHelp;
}

void Input::apply(const WindowEvents& events, const Window& window, double elapsed_s, Session& session)
{
	for (const KeyPress& press : events.keys)
		pressKey(press, session);
	for (const std::string& path : events.dropped)
		drop(path, session);
	const dvec2 mouse = window.mousePx();
	if (events.scrolled != 0 && isOverPicture(mouse, session))
		movedCamera(window, session) = dollied(movedCamera(window, session), events.scrolled);
	moveByMouse(window, session);
	if (!ImGui::GetIO().WantTextInput)
		fly(window, elapsed_s, session);
	last_mouse_px_ = mouse;
}

void Input::pressKey(const KeyPress& press, Session& session)
{
	Requests& requests = session.requests;
	const bool is_typing = ImGui::GetIO().WantTextInput;
	switch (press.key)
	{
	case GLFW_KEY_F1:
		session.shows_interface = !session.shows_interface;
		return;
	case GLFW_KEY_F9:
		requests.write_state = true;
		return;
	case GLFW_KEY_F11:
		requests.switch_full_screen = true;
		return;
	case GLFW_KEY_F12:
		requests.screenshot = true;
		return;
	case GLFW_KEY_ESCAPE:
		session.asks_for_path = false;
		return;
	default:
		break;
	}
	if (press.control)
	{
		requests.quit |= press.key == GLFW_KEY_Q;
		requests.copy_command |= press.key == GLFW_KEY_C && !is_typing;
		session.asks_for_path |= press.key == GLFW_KEY_O;
		return;
	}
	if (is_typing)
		return;
	if (press.key == GLFW_KEY_EQUAL || press.key == GLFW_KEY_KP_ADD)
		changeRate(session, kRateStep);
	if (press.key == GLFW_KEY_MINUS || press.key == GLFW_KEY_KP_SUBTRACT)
		changeRate(session, 1 / kRateStep);
	requests.frame_selection |= press.key == GLFW_KEY_F;
	requests.reset_camera |= press.key == GLFW_KEY_HOME;
	requests.reload_shaders |= press.key == GLFW_KEY_R;
	if (press.key == GLFW_KEY_Q)
	{
		if (!session.separates())
			session.culled_camera = session.camera;
		session.debug_camera = !session.debug_camera;
	}
	if (press.key == GLFW_KEY_V)
		session.vsync = !session.vsync;
}

void Input::moveByMouse(const Window& window, Session& session)
{
	const dvec2 mouse = window.mousePx();
	if (dragged_button_ >= 0 && !window.isButtonDown(dragged_button_))
	{
		endDrag(mouse, session);
		dragged_button_ = -1;
	}
	if (dragged_button_ < 0)
	{
		if (!isOverPicture(mouse, session))
			return;
		for (int button : { GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOUSE_BUTTON_MIDDLE })
			if (window.isButtonDown(button))
				beginDrag(button, mouse);
		return;
	}
	const dvec2 moved = mouse - last_mouse_px_;
	if (moved == dvec2(0))
		return;
	dragged_px_ += std::abs(moved.x) + std::abs(moved.y);
	Camera& camera = movedCamera(window, session);
	const bool looks_around = window.isKeyDown(GLFW_KEY_LEFT_CONTROL) || window.isKeyDown(GLFW_KEY_RIGHT_CONTROL);
	if (dragged_button_ != GLFW_MOUSE_BUTTON_LEFT)
		camera = panned(camera, moved, session.viewport_size.y);
	else if (looks_around)
		camera = turned(camera, dvec2(moved.x, -moved.y) * kRadPerPx);
	else
		camera = orbited(camera, dvec2(-moved.x, moved.y) * kRadPerPx);
}

void Input::beginDrag(int button, dvec2 mouse_px)
{
	dragged_button_ = button;
	dragged_px_ = 0;
	drag_start_px_ = mouse_px;
}

// A drag that went nowhere was a click.
void Input::endDrag(dvec2 mouse_px, Session& session)
{
	if (dragged_button_ != GLFW_MOUSE_BUTTON_LEFT || dragged_px_ > kClickPx)
		return;
	const double time = glfwGetTime();
	const bool is_double = time - last_click_s_ < kDoubleClick_s && glm::length(mouse_px - last_click_px_) < kClickPx;
	(is_double ? session.requests.recentre : session.requests.pick) = pictureXy(drag_start_px_, session);
	last_click_s_ = is_double ? 0 : time;
	last_click_px_ = mouse_px;
}

void Input::fly(const Window& window, double elapsed_s, Session& session) const
{
	if (window.isKeyDown(GLFW_KEY_LEFT_CONTROL) || window.isKeyDown(GLFW_KEY_RIGHT_CONTROL) || !session.scene)
		return;
	const auto held = [&](int key) {
		return window.isKeyDown(key) ? 1.0 : 0.0;
	};
	const dvec3 direction = { held(GLFW_KEY_D) - held(GLFW_KEY_A), held(GLFW_KEY_E) - held(GLFW_KEY_C), held(GLFW_KEY_W) - held(GLFW_KEY_S) };
	if (direction == dvec3(0))
		return;
	const double speed = boundingRadius(session.scene->subject.scene) * 0.7;
	movedCamera(window, session) = flown(movedCamera(window, session), direction * (speed * std::min(elapsed_s, 0.2)));
}

void Input::drop(const std::string& path, Session& session) const
{
	std::string lower = path;
	std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
	const bool is_image = lower.ends_with(".png") || lower.ends_with(".jpg") || lower.ends_with(".jpeg") || lower.ends_with(".exr");
	if (!is_image || !session.scene)
	{
		session.requests.open = path;
		return;
	}
	// A height map: on the material that was picked last, or on all; as deep as a fiftieth of the scene.
	const double factor = boundingRadius(session.scene->subject.scene) / 50;
	std::string displacement = fmt::format("{}:{:.3g}", path, factor);
	if (session.inspection && session.inspection->covered)
		displacement += fmt::format(":0:{}", session.inspection->material_name);
	session.options.displacements.push_back(displacement);
}

}  // namespace tessera::view
