// The viewer: one window, one scene at a time, drawn again and again by the frame that `tessera render` draws.
#pragma once
#include "app/command_line.h"
#include "viewer/input.h"
#include "viewer/log_inbox.h"
#include "viewer/presenter.h"
#include "viewer/session.h"
#include "viewer/shader_compiler.h"
#include "viewer/ui.h"

#include <chrono>

namespace tessera::view
{

// How a frame becomes a picture in the window: the frame is submitted and polled; when the device has said that it fitted (else it is drawn again by
// itself), its picture is copied into an image with the next frame of the window, and only then the next frame is begun. The host waits
// for neither, the device never for the host within a frame, and no picture with a hole is ever shown.
class Viewer
{
public:
	explicit Viewer(const CommandLine& line);
	// Until the window is closed or --frames are shown. Errors: DeviceCannot (no window, no device), DeviceLost.
	Status run();

private:
	using Clock = std::chrono::steady_clock;

	Status openDevice();
	void closeDevice();
	Status turn();       // one turn of the loop
	void takeScene();    // from the loader, between two frames
	Status pollScene();  // takes the result of the frame that is drawn, when there is one
	void beginScene();   // begins the next frame
	void keepSceneOptions();
	Status changeDevice();
	bool followOptions();  // what changed since the last frame; false when it cannot be drawn so
	Status drawWindow();   // the window's own frame
	void doRequests();
	void load(const std::string& scene, bool keeps_camera);
	void takeScreenshot();
	void copyCommand();
	void frameSelection();
	void loadPath(const std::string& file);
	void movePath(double elapsed_s);  // plays or records
	void reloadShaders();
	void takeShaders();  // that were compiled, between two frames
	Status readBack();   // gizmos and the inspected pixel, of a frame that is finished
	Status writeState();
	void takeLog();
	void report(const Error& error);
	double now() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

	const CommandLine& line_;
	Session session_;
	Ui ui_;
	Input input_;
	LogInbox log_inbox_;
	SceneLoader loader_;
	ShaderReloader reloader_;
	std::unique_ptr<Window> window_;
	std::unique_ptr<Device> device_;
	std::unique_ptr<Presenter> presenter_;
	std::unique_ptr<Renderer> renderer_;
	std::shared_ptr<LoadedScene> renderer_scene_;       // that renderer_ draws: it must outlive it
	std::shared_ptr<LoadedScene> next_scene_;           // loaded, and taken between two frames
	AppOptions applied_;                                // what renderer_ has
	AppOptions loaded_;                                 // what the scene was asked for with
	std::unique_ptr<reference::HostScene> host_scene_;  // of renderer_scene_, made when first needed
	std::optional<uvec2> asked_pixel_, asked_centre_;   // of the frame that is drawn
	ShownFrame running_;                                // the frame that is drawn
	bool is_running_ = false, has_picture_ = false;     // a picture waits for the window
	bool has_news_ = false;                             // for the window's next frame, beside a picture
	bool wants_device_ = false;                         // another one, before the next frame
	bool has_failed_ = false;                           // the last frame could not be drawn: waits for other options
	uint64_t begun_ = 0, written_ = 0, screenshots_ = 0;
	Clock::time_point started_ = Clock::now();
	double recorded_s_ = 0;  // since the last key
	double last_turn_s_ = 0, last_window_s_ = 0, last_picture_s_ = 0;
};

}  // namespace tessera::view

namespace tessera
{

// Opens a window on the scene. Errors: those of Viewer::run; CheckFailed when the validation layer had something to say.
Status viewCommand(const CommandLine& line);

}  // namespace tessera
