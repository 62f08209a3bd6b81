// Where the picture is seen from.
#include "viewer/camera_control.h"
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr std::string_view kOptions[] = { "eye", "target", "up", "fov", "ortho", "near", "camera" };

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

void draw(Ui& ui, Session& session)
{
	drawFields(ui, session);
	session.requests.reset_camera |= ui.button("camera.reset", "reset", "back to where the scene was opened (Home)");
	ImGui::SameLine();
	session.requests.frame_selection |= ui.button("camera.frame", "frame", "bring the whole scene into view (F)");
	ImGui::SameLine();
	session.requests.copy_command |=
		ui.button("camera.copy", "copy command", "put the `tessera render` command of this picture on the clipboard and into the log (Ctrl+C)");
	drawFileCameras(ui, session);
}

}  // namespace

const Panel kCameraPanel = { "Camera", "where the picture is seen from", draw, kOptions };

}  // namespace tessera::view
