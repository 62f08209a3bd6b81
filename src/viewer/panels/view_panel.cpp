// What the picture shows.
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

constexpr std::string_view kOptions[] = { "view",
										  "wireframe",
										  "shading",
										  "shadows",
										  "ao",
										  "ao-radius",
										  "ray-falloff",
										  "ray-hidden",
										  "rays",
										  "ray-sharing",
										  "transient-1x1x1",
										  "transient-2x2x2",
										  "transient-build",
										  "position-truncation",
										  "max-cluster-data",
										  "max-cluster-vertices" };

void draw(Ui& ui, Session& session)
{
	ui.option("view", session.options);
	ui.option("wireframe", session.options);
	ui.option("shading", session.options);
	for (const char* option : { "shadows", "ao", "ao-radius", "ray-falloff", "ray-hidden", "rays", "ray-sharing", "transient-1x1x1",
								"transient-2x2x2", "transient-build", "position-truncation", "max-cluster-data", "max-cluster-vertices" })
		ui.option(option, session.options);
	const ViewMode view = session.options.view;
	const char* scale = view == ViewMode::Factors ? "1 (blue) to 11 (red) segments"
						: view == ViewMode::Area  ? "1/16 (blue) to 256 (red) square pixels, logarithmic"
						: view == ViewMode::Error ? "1/64 (blue) to 16 (red) pixels from a surface at an eighth of the rate, logarithmic"
												  : "";
	ImGui::TextWrapped("%s", scale);
}

}  // namespace

const Panel kViewPanel = { "View", "what the picture shows", draw, kOptions };

}  // namespace tessera::view
