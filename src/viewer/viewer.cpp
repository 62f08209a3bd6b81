#include "viewer/viewer.h"

#include "app/option_text.h"
#include "app/stats_json.h"
#include "base/log.h"
#include "viewer/interface.h"
#include "viewer/settings.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

namespace tessera::view
{

namespace
{

constexpr double kWindowPeriod_s = 1.0 / 60;  // of the window's frames while the scene's takes longer
constexpr double kPollPeriod_s = 0.002;
constexpr double kIdlePeriod_s = 0.1;  // minimised
constexpr size_t kMostLogEntries = 500;

}  // namespace

Viewer::Viewer(const CommandLine& line) : line_(line), reloader_(line.shaders.empty() ? shaderSourceFolder() : std::filesystem::path(line.shaders))
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
	if (session_.devices.empty())
	{
		TRY_ASSIGN(session_.devices, listDevices());
	}
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
	uvec2 size = { line_.options.width_px, line_.options.height_px };
	std::filesystem::path settings = line_.settings == "off" ? std::string() : line_.settings;
	if (line_.settings.empty())
		settings = settingsFile();
	const uvec2 kept = settings.empty() ? uvec2(0) : applySettings(readSettings(settings), session_);
	if (kept.x > 0 && !line_.has_size)
		size = kept;
	TRY_ASSIGN(window_, Window::create(size.x, size.y, false));
	startInterface(window_->contentScale());
	load(line_.scene.empty() ? std::string("builtin:planet") : line_.scene, false);
	Status status = openDevice();
	while (status && !window_->wantsClose())
		status = turn();
	const uint32_t messages = device_ ? device_->validationMessages() : 0;
	if (status && !line_.ui_state.empty())
		status = writeState();
	if (status && !settings.empty() && window_->sizePx().x > 0)
		status = writeJson(settings, settingsJson(session_, window_->sizePx()));
	closeDevice();
	endInterface();
	window_.reset();
	TRY(status);
	if (messages > 0)
		return fail(ExitCode::CheckFailed, "--validate: the validation layer had {}", counted(messages, "message"));
	return {};
}

Status Viewer::turn()
{
	const bool idles = window_->sizePx().x == 0;
	const bool draws_nothing = !renderer_ || has_failed_;
	const WindowEvents events = window_->poll(idles ? kIdlePeriod_s : is_running_ ? kPollPeriod_s : draws_nothing ? kWindowPeriod_s : 0);
	const double time = now();
	input_.apply(events, *window_, time - last_turn_s_, session_);
	movePath(time - last_turn_s_);
	last_turn_s_ = time;
	takeLog();
	TRY(pollScene());
	// The window is drawn for every picture; and while there is none for a while, for what the user does.
	has_news_ |= events.any || loader_.isLoading();
	if (has_picture_ || !is_running_ || (has_news_ && time - last_window_s_ >= kWindowPeriod_s))
		TRY(drawWindow());
	session_.requests.reload_shaders |= reloader_.sourcesChanged(time);
	doRequests();
	if (is_running_ || has_picture_ || idles)
		return {};
	if (line_.frame_limit > 0 && session_.shown.number >= line_.frame_limit)
	{
		window_->close();
		return {};
	}
	if (wants_device_)
		TRY(changeDevice());
	takeScene();
	takeShaders();
	beginScene();
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
	has_news_ = false;
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
