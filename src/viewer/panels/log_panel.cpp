// What the program said.
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

void draw(Ui&, Session& session)
{
	for (const LogEntry& entry : session.log)
	{
		if (entry.is_warning)
			ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.75f, 0.35f, 1));
		ImGui::TextWrapped("%s", entry.text.c_str());
		if (entry.is_warning)
			ImGui::PopStyleColor();
	}
}

}  // namespace

const Panel kLogPanel = { "Log", "what the program said", draw, {} };

}  // namespace tessera::view
