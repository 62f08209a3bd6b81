#include "viewer/viewer.h"

#include "app/option_text.h"
#include "app/stats_json.h"
#include "base/log.h"
#include "output/png.h"
#include "pipeline/passes.h"
#include "viewer/camera_control.h"
#include "viewer/interface.h"
#include "viewer/option_text_form.h"
#include "viewer/panels/panels.h"
#include "viewer/ui_state.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include <algorithm>
#include <filesystem>

namespace tessera::view
{

namespace
{

constexpr double kWindowPeriod_s = 1.0 / 60;  // of the window's frames while the scene's takes longer
constexpr double kPollPeriod_s = 0.002;
constexpr double kIdlePeriod_s = 0.1;  // minimised
constexpr size_t kMostLogEntries = 500;

double radiusOf(const BuiltScene& scene)
{
	return std::max(boundingRadius(scene), 1e-6);
}

}  // namespace

Viewer::Viewer(const CommandLine& line) : line_(line)
{
	session_.options = line.options;
	session_.shows_interface = line.shows_interface;
	session_.loader = &loader_;
	session_.open_panels = { { "Tessellation", true }, { "View", true } };
}

Status Viewer::openDevice()
{
	DeviceRequest request = { session_.options.device, session_.options.validate, session_.options.pipeline_statistics, {}, {} };
	window_->addTo(request);
	TRY_ASSIGN(device_, Device::create(request));
	logInfo("device {}, driver {}", device_->name, device_->driver);
	TRY_ASSIGN(presenter_, Presenter::create(*device_, *window_, session_.vsync));
	session_.device = device_.get();
	session_.can_switch_vsync = presenter_->canSwitchVsync();
	applied_ = session_.options;
	return {};
}

void Viewer::closeDevice()
{
	if (device_)
		vkDeviceWaitIdle(device_->handle);
	is_running_ = has_picture_ = false;
	renderer_.reset();
	presenter_.reset();
	device_.reset();
}

Status Viewer::run()
{
	TRY_ASSIGN(window_, Window::create(line_.options.width_px, line_.options.height_px, false));
	startInterface(window_->contentScale());
	load(line_.scene.empty() ? std::string("builtin:planet") : line_.scene, false);
	Status status = openDevice();
	while (status && !window_->wantsClose())
		status = turn();
	const uint32_t messages = device_ ? device_->validationMessages() : 0;
	if (status && !line_.ui_state.empty())
		status = writeState();
	closeDevice();
	endInterface();
	setLogListener({});
	window_.reset();
	TRY(status);
	if (messages > 0)
		return fail(ExitCode::CheckFailed, "--validate: the validation layer had {}", counted(messages, "message"));
	return {};
}

Status Viewer::turn()
{
	const bool idles = window_->sizePx().x == 0;
	const WindowEvents events = window_->poll(idles ? kIdlePeriod_s : is_running_ ? kPollPeriod_s : 0);
	const double time = now();
	input_.apply(events, *window_, time - last_turn_s_, session_);
	last_turn_s_ = time;
	takeLog();
	TRY(pollScene());
	// The window is drawn for every picture; and while there is none for a while, for what the user does.
	if (has_picture_ || !is_running_ || time - last_window_s_ >= kWindowPeriod_s)
		TRY(drawWindow());
	doRequests();
	if (is_running_ || has_picture_ || idles)
		return {};
	if (line_.frame_limit > 0 && session_.shown.number >= line_.frame_limit)
	{
		window_->close();
		return {};
	}
	takeScene();
	beginScene();
	return {};
}

void Viewer::load(const std::string& scene, bool keeps_camera)
{
	loaded_ = session_.options;
	loader_.start({ scene, session_.options, keeps_camera });
}

void Viewer::takeScene()
{
	if (auto loaded = loader_.take())
	{
		if (!*loaded)
			report(loaded->error());
		else
			next_scene_ = std::move(**loaded);
	}
	if (!next_scene_)
		return;
	auto made = Renderer::create(*device_, next_scene_->subject.scene, next_scene_->subject.table, framePasses(), session_.options);
	const std::shared_ptr<LoadedScene> scene = std::exchange(next_scene_, nullptr);
	if (!made)
		return report(made.error());
	renderer_ = std::move(*made);
	applied_ = session_.options;
	const bool keeps_camera = scene->request.keeps_camera && session_.scene;
	session_.scene = renderer_scene_ = scene;
	session_.scene_name = scene->request.scene;
	session_.error.clear();
	session_.high_water.clear();
	has_failed_ = false;
	if (!keeps_camera)
		session_.camera = scene->subject.camera;
	window_->setTitle("tessera: " + session_.scene_name);
}

bool Viewer::followOptions()
{
	session_.options.width_px = session_.viewport_size.x;
	session_.options.height_px = session_.viewport_size.y;
	const Rebuild stale = staleAfter(applied_, session_.options);
	const bool differs = optionsJson(applied_) != optionsJson(session_.options);
	if (!differs)
		return !has_failed_;
	const bool needs_scene = stale >= Rebuild::Scene || applied_.table != session_.options.table;
	if (const Status set = renderer_->setOptions(session_.options); !set)
	{
		report(set.error());
		const uint32_t width = session_.options.width_px, height = session_.options.height_px;
		session_.options = applied_;
		session_.options.width_px = width;
		session_.options.height_px = height;
		return false;
	}
	applied_ = session_.options;
	has_failed_ = false;
	if (needs_scene)
		load(session_.scene_name, true);
	return true;
}

void Viewer::beginScene()
{
	if (!renderer_ || !followOptions())
		return;
	running_ = {};
	running_.number = ++begun_;
	running_.camera = session_.camera;
	running_.options = session_.options;
	if (const Status begun = renderer_->beginFrame(session_.camera); !begun)
	{
		has_failed_ = true;
		return report(begun.error());
	}
	is_running_ = true;
}

Status Viewer::pollScene()
{
	if (!is_running_)
		return {};
	auto polled = renderer_->pollFrame();
	if (!polled)
	{
		is_running_ = false;
		has_failed_ = true;
		if (polled.error().code == ExitCode::DeviceLost)
			return tl::unexpected(polled.error());
		report(polled.error());
		return {};
	}
	if (!*polled)
		return {};
	is_running_ = false;
	has_picture_ = true;
	running_.result = std::move(**polled);
	running_.plan = renderer_->plan();
	running_.input = renderer_->planInput();
	running_.memory = renderer_->memory();
	return {};
}

Status Viewer::drawWindow()
{
	const uvec2 size = window_->sizePx();
	if (size.x == 0 || size.y == 0)
	{
		has_picture_ = false;
		return {};
	}
	last_window_s_ = now();
	if (has_picture_)
	{
		session_.shown = running_;
		session_.high_water.add(running_.result.lists);
		session_.frame_ms.add(last_window_s_, (last_window_s_ - last_picture_s_) * 1e3);
		session_.device_ms.add(last_window_s_, running_.result.gpu_ms);
		for (const PassTime& pass : running_.result.passes)
			session_.pass_ms[pass.name].add(last_window_s_, pass.gpu_ms);
		last_picture_s_ = last_window_s_;
	}
	ImGui_ImplVulkan_NewFrame();
	ImGui_ImplGlfw_NewFrame();
	ImGui::NewFrame();
	drawInterface(ui_, session_, size);
	ImGui::Render();
	presenter_->setVsync(session_.vsync);
	std::optional<ScenePicture> picture;
	if (has_picture_)
		picture = { renderer_->pictureBuffer(), { running_.input.options.width_px, running_.input.options.height_px } };
	TRY_ASSIGN(const bool shown, presenter_->draw(picture, ivec2(session_.viewport_low), ImGui::GetDrawData()));
	has_picture_ &= !shown;
	return {};
}

void Viewer::doRequests()
{
	Requests requests = std::exchange(session_.requests, {});
	if (requests.quit)
		window_->close();
	if (requests.open)
		load(*requests.open, false);
	if (requests.switch_full_screen)
		window_->setFullScreen(!window_->isFullScreen());
	session_.is_full_screen = window_->isFullScreen();
	if (requests.fit_lists)
		session_.options.capacities = session_.high_water.fittingCapacities();
	if (requests.fit_lists)
		session_.options.lists_bytes = 0;
	if (requests.write_state)
		if (const Status written = writeState(); !written)
			report(written.error());
	if (!session_.scene)
		return;
	const Subject& subject = session_.scene->subject;
	if (requests.reset_camera)
		session_.camera = subject.camera;
	if (requests.file_camera)
		session_.camera = cameraOf(subject.scene.cameras[*requests.file_camera], subject.scene);
	if (requests.frame_selection)
		session_.camera = framing(session_.camera, (subject.scene.world_low + subject.scene.world_high) / 2.0, radiusOf(subject.scene),
								  double(session_.viewport_size.x) / session_.viewport_size.y);
	if (requests.copy_command)
		copyCommand();
	if (requests.screenshot && !is_running_ && renderer_)
		takeScreenshot();
	else
		session_.requests.screenshot |= requests.screenshot;
}

void Viewer::copyCommand()
{
	session_.command_line = renderCommandLine(session_.scene_name, session_.options, session_.camera);
	window_->setClipboard(session_.command_line);
	logInfo("{}", session_.command_line);
}

void Viewer::takeScreenshot()
{
	std::string path;
	do
		path = fmt::format("tessera_{}.png", ++screenshots_);
	while (std::filesystem::exists(path));
	const RenderOptions& options = renderer_->planInput().options;
	const auto picture = renderer_->readPicture();
	if (!picture)
		return report(picture.error());
	if (const Status written = writePng(path, options.width_px, options.height_px, *picture, 4); !written)
		return report(written.error());
	logInfo("wrote {}", path);
}

Status Viewer::writeState()
{
	if (line_.ui_state.empty())
		return {};
	// Whole or not at all: a script may be reading it.
	const std::string partial = line_.ui_state + ".partial";
	TRY(writeJson(partial, uiState(session_, ui_, ++written_)));
	std::error_code error;
	std::filesystem::rename(partial, line_.ui_state, error);
	if (error)
		return badInput("{}: {}", line_.ui_state, error.message());
	return {};
}

void Viewer::report(const Error& error)
{
	session_.error = error.message;
	logWarning("{}", error.message);
}

void Viewer::takeLog()
{
	for (LogEntry& entry : log_inbox_.take())
		session_.log.push_back(std::move(entry));
	while (session_.log.size() > kMostLogEntries)
		session_.log.pop_front();
}

}  // namespace tessera::view

namespace tessera
{

Status viewCommand(const CommandLine& line)
{
	return view::Viewer(line).run();
}

}  // namespace tessera
