// What panels and keys ask of the viewer.
#include "app/stats_json.h"
#include "base/file.h"
#include "base/log.h"
#include "output/png.h"
#include "viewer/camera_control.h"
#include "viewer/option_text_form.h"
#include "viewer/ui_state.h"
#include "viewer/viewer.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace tessera::view
{

namespace
{

constexpr double kRecordPeriod_s = 0.25;

double radiusOf(const BuiltScene& scene)
{
	return std::max(boundingRadius(scene), 1e-6);
}

}  // namespace

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
		frameSelection();
	if (requests.save_path && !session_.path.keys.empty())
		if (const Status written = writeFile(session_.path_file, cameraPathText(session_.path)); !written)
			report(written.error());
	if (requests.load_path)
		loadPath(session_.path_file);
	if (requests.copy_command)
		copyCommand();
	if (requests.reload_shaders && renderer_)
		reloadShaders();
	session_.requests.pick = requests.pick;
	session_.requests.recentre = requests.recentre;
	if (requests.screenshot && !is_running_ && renderer_)
		takeScreenshot();
	else
		session_.requests.screenshot |= requests.screenshot;
}

// The instance that was picked last, or the whole scene.
void Viewer::frameSelection()
{
	const BuiltScene& scene = session_.scene->subject.scene;
	dvec3 centre = (scene.world_low + scene.world_high) / 2.0;
	double radius = radiusOf(scene);
	if (session_.inspection && session_.inspection->covered)
	{
		const Instance& instance = scene.instances[session_.inspection->cluster.instance];
		const Box box = displacedBox(scene.mesh_bounds[instance.mesh], session_.options.displacement_scale, session_.options.displacement_offset);
		centre = dvec3(instance.world * dvec4(dvec3(box.low + box.high) / 2.0, 1));
		const dvec3 half = dvec3(box.high - box.low) / 2.0;
		radius = glm::length(dvec3(instance.world[0])) * half.x + glm::length(dvec3(instance.world[1])) * half.y +
				 glm::length(dvec3(instance.world[2])) * half.z;
		radius = std::max(radius, radiusOf(scene) * 1e-6);
	}
	session_.camera = framing(session_.camera, centre, radius, double(session_.viewport_size.x) / session_.viewport_size.y);
}

void Viewer::reloadShaders()
{
	if (!reloader_.hasSources())
		return report({ ExitCode::BadInput, fmt::format("no sources of the shaders in {}; --shaders names a folder", reloader_.folder().string()) });
	reloader_.start(renderer_->shaderNames());
}

void Viewer::loadPath(const std::string& file)
{
	auto path = readCameraPath(file);
	if (!path)
		return report(path.error());
	session_.path = std::move(*path);
	session_.path_file = file;
	session_.error.clear();
}

void Viewer::movePath(double elapsed_s)
{
	CameraPath& path = session_.path;
	if (session_.plays_path)
	{
		session_.path_time_s += elapsed_s;
		session_.camera = path.at(session_.path_time_s);
		session_.plays_path = session_.path_time_s < path.duration_s();
		return;
	}
	if (!session_.records_path || (!path.keys.empty() && path.keys.back().camera == session_.camera))
		return;
	recorded_s_ += elapsed_s;
	if (path.keys.empty() || recorded_s_ >= kRecordPeriod_s)
	{
		path.keys.push_back({ path.keys.empty() ? 0 : path.duration_s() + recorded_s_, session_.camera });
		recorded_s_ = 0;
	}
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
	return writeJson(line_.ui_state, uiState(session_, ui_, ++written_));
}

void Viewer::report(const Error& error)
{
	session_.error = error.message;
	logWarning("{}", error.message);
}

}  // namespace tessera::view
