// Shaders, compiled again while the program runs.
#include "app/option_text.h"
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

void draw(Ui& ui, Session& session)
{
	const ShaderState& shaders = session.shaders;
	session.requests.reload_shaders |=
		ui.button("shaders.reload", "reload",
				  "compile the sources again (R); it is done by itself when one of them changes.\nUntil all are good the old ones stay");
	if (shaders.is_compiling)
		ImGui::TextUnformatted("compiling ...");
	else if (shaders.reloads > 0 && shaders.error.empty())
		ImGui::Text("%s replaced by the last reload", counted(shaders.replaced, "shader").c_str());
	if (shaders.error.empty())
		return;
	ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.45f, 0.35f, 1));
	ImGui::TextWrapped("%s", shaders.error.c_str());
	ImGui::PopStyleColor();
}

}  // namespace

const Panel kShadersPanel = { "Shaders", "compile the shaders again", draw, {} };

}  // namespace tessera::view
