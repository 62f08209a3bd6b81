// Where the picture is seen from.
#include "viewer/camera_control.h"
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr std::string_view kOptions[] = { "eye", "target", "up", "fov", "ortho", "near", "camera", "camera-path" };

bool vectorRow(Ui& ui, const std::string& name, dvec3& vector, const std::string& tooltip)
{
	ImGui::InputScalarN((name + "##" + name).c_str(), ImGuiDataType_Double, &vector.x, 3, nullptr, nullptr, "%.5g");
	const bool done = ImGui::IsItemDeactivatedAfterEdit();
	ui.note(name, tooltip);
	return done;
}

bool spansView(const Camera& camera)
{
	const dvec3 view = camera.target - camera.eye;
	return glm::length(view) > 0 && glm::length(glm::cross(view, camera.up)) > 1e-9 * glm::length(view) * glm::length(camera.up);
}

void drawFields(Ui& ui, Session& session)
{
	Camera camera = session.camera;
	vectorRow(ui, "eye", camera.eye, "where the camera is, in world units");
	vectorRow(ui, "target", camera.target, "what it looks at and turns around");
	vectorRow(ui, "up", camera.up, "what is up in the picture");
	if (spansView(camera))
		session.camera = camera;
	float fov = static_cast<float>(session.camera.fov_y_rad / kDegree);
	if (ui.slider("fov", "field of view", fov, 1, 150, "vertical field of view, degrees; makes an orthographic camera a perspective one"))
		session.camera = withFov(session.camera, double(fov));
	double near = session.camera.near_world;
	if (ui.number("near", "near", near, "nothing nearer is drawn, world units; 0: radius of the scene / 1000"))
		session.camera.near_world = near > 0 ? std::max(near, 1e-6) : 0;
}

void drawFileCameras(Ui& ui, Session& session)
{
	if (!session.scene || session.scene->subject.scene.cameras.empty())
		return;
	ImGui::TextUnformatted("cameras of the scene");
	const auto& cameras = session.scene->subject.scene.cameras;
	for (size_t i = 0; i < cameras.size(); ++i)
		if (ui.button(fmt::format("camera.{}", i), cameras[i].name.empty() ? fmt::format("camera {}", i) : cameras[i].name,
					  "look through this camera"))
			session.requests.file_camera = i;
}

constexpr double kKeyStep_s = 2;  // between viewpoints that are stored by hand

void drawPath(Ui& ui, Session& session)
{
	CameraPath& path = session.path;
	ImGui::Text("%zu viewpoints, a path of %.1f s", path.keys.size(), path.duration_s());
	if (ui.button("path.store", "store", "this view becomes the path's next key, two seconds after the last"))
		path.keys.push_back({ path.keys.empty() ? 0 : path.duration_s() + kKeyStep_s, session.camera });
	ImGui::SameLine();
	if (ui.button("path.record", session.records_path ? "stop recording" : "record", "store the view four times a second while it moves"))
		session.records_path = !session.records_path;
	ImGui::SameLine();
	if (ui.button("path.play", session.plays_path ? "stop" : "play", "move along the path from its start") && !path.keys.empty())
	{
		session.plays_path = !session.plays_path;
		session.path_time_s = 0;
	}
	ImGui::SameLine();
	if (ui.button("path.clear", "clear", "forget all viewpoints"))
		path.keys.clear();
	session.plays_path &= !path.keys.empty();
	for (size_t i = 0; i < path.keys.size() && i < 24; ++i)
	{
		if (ui.button(fmt::format("path.key.{}", i), fmt::format("{}", i + 1), fmt::format("back to the view at {:.2f} s", path.keys[i].time_s)))
			session.camera = path.keys[i].camera;
		if (i % 8 != 7)
			ImGui::SameLine();
	}
	ImGui::NewLine();
	ui.text("path.file", "file", session.path_file, "JSON; `tessera render --camera-path` takes it too");
	session.requests.save_path |= ui.button("path.save", "save", "write the path to the file");
	ImGui::SameLine();
	session.requests.load_path |= ui.button("path.load", "load", "read the path from the file");
}

void draw(Ui& ui, Session& session)
{
	drawFields(ui, session);
	session.requests.reset_camera |= ui.button("camera.reset", "reset", "back to where the scene was opened (Home)");
	ImGui::SameLine();
	session.requests.frame_selection |=
		ui.button("camera.frame", "frame", "bring the instance that was picked last, or the whole scene, into view (F)");
	ImGui::SameLine();
	session.requests.copy_command |=
		ui.button("camera.copy", "copy command", "put the `tessera render` command of this picture on the clipboard and into the log (Ctrl+C)");
	drawFileCameras(ui, session);
	ImGui::Separator();
	drawPath(ui, session);
}

}  // namespace

const Panel kCameraPanel = { "Camera", "where the picture is seen from", draw, kOptions };

}  // namespace tessera::view
