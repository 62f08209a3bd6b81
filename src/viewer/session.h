// What the viewer knows and shows, and what its panels ask for. Panels read it, change `options` and set requests; the viewer does the rest
// between two frames.
#pragma once
#include "app/camera_path.h"
#include "app/options.h"
#include "frame/renderer.h"
#include "viewer/history.h"
#include "viewer/inspector.h"
#include "viewer/limits.h"
#include "viewer/loader.h"

#include <deque>
#include <map>
#include <memory>

namespace tessera::view
{

// The frame whose picture is in the window.
struct ShownFrame
{
	uint64_t number = 0;  // 0: none yet
	Camera camera;        // that it was culled and tessellated for
	Camera drawn_from;    // that it is seen from
	AppOptions options;
	FrameResult result;
	FramePlan plan;
	PlanInput input;
	MemoryStats memory;
	std::vector<ClusterRef> visible;  // only while gizmos are drawn
};

// Lines over the picture.
struct Gizmos
{
	bool instances = false, clusters = false, cones = false;
	bool kept = true, culled = true;  // which of them
	bool any() const { return instances || clusters || cones; }
};

struct ShaderState
{
	bool is_compiling = false;
	uint64_t reloads = 0;  // that came to something
	size_t replaced = 0;   // by the last
	std::string error;     // the compiler's text; empty: the last reload was good
};

struct LogEntry
{
	std::string text;
	bool is_warning = false;
};

// Asked for by panels and keys, done and cleared by the viewer.
struct Requests
{
	std::optional<std::string> open;    // a scene
	std::optional<size_t> file_camera;  // of the scene
	bool reset_camera = false, frame_selection = false, copy_command = false, screenshot = false, reload_shaders = false;
	std::optional<uvec2> pick;      // a pixel of the picture
	std::optional<uvec2> recentre;  // on what this pixel sees
	bool save_path = false, load_path = false;
	bool write_state = false, switch_full_screen = false, quit = false, fit_lists = false;
};

struct Session
{
	// Scene and how it is drawn.
	std::shared_ptr<LoadedScene> scene;
	std::string scene_name;  // as it was asked for
	AppOptions options;      // as the panels have it: the next frame follows
	Camera camera;           // that the picture is drawn from
	// Culling and tessellation stay for (frozen), or follow (the debug camera, moved with Shift), another camera.
	Camera culled_camera;
	bool is_frozen = false, debug_camera = false;
	bool separates() const { return is_frozen || debug_camera; }
	Gizmos gizmos;

	// What has been seen.
	ShownFrame shown;
	HighWater high_water;
	History frame_ms, device_ms;  // from picture to picture, and of the passes
	std::map<std::string, History> pass_ms;
	std::deque<LogEntry> log;
	std::string error;         // of the last thing that could not be done, one line; stays until something can
	std::string command_line;  // that was copied last
	std::optional<Inspection> inspection;
	ShaderState shaders;

	// The window.
	bool shows_interface = true;
	std::map<std::string, bool> open_panels;
	bool vsync = true, can_switch_vsync = true, is_full_screen = false;
	bool asks_for_path = false;  // the File > Open field is there
	std::string typed_path;
	uvec2 viewport_low = { 0, 0 }, viewport_size = { 1, 1 };  // of the picture, in pixels of the window
	const SceneLoader* loader = nullptr;
	std::vector<std::string> devices;  // of the system
	const Device* device = nullptr;
	Requests requests;

	// Stored viewpoints, which are a path when they are played.
	CameraPath path;
	std::string path_file = "camera_path.json";
	bool records_path = false, plays_path = false;
	double path_time_s = 0;  // while it plays
};

}  // namespace tessera::view
