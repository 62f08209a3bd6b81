// What keys and the mouse do outside the panels.
#pragma once
#include "viewer/session.h"
#include "viewer/window.h"

namespace tessera::view
{

class Input
{
public:
	// Turns events into movements of the session's camera and into requests. `elapsed_s`: since the last call, for flying.
	void apply(const WindowEvents& events, const Window& window, double elapsed_s, Session& session);

private:
	void pressKey(const KeyPress& press, Session& session);
	void moveByMouse(const Window& window, Session& session);
	void fly(const Window& window, double elapsed_s, Session& session) const;
	void drop(const std::string& path, Session& session) const;

	void beginDrag(int button, dvec2 mouse_px);
	void endDrag(dvec2 mouse_px, Session& session);

	dvec2 last_mouse_px_ = dvec2(0), drag_start_px_ = dvec2(0), last_click_px_ = dvec2(0);
	double dragged_px_ = 0, last_click_s_ = 0;
	int dragged_button_ = -1;  // that went down over the picture and is still held
};

// "Key: what it does" lines for the help.
std::span<const std::string_view> keyHelp();

}  // namespace tessera::view
