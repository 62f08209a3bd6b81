// The user interface over the picture: menu, side bar of panels, open field, messages.
#pragma once
#include "viewer/session.h"
#include "viewer/ui.h"

namespace tessera::view
{

// Makes ImGui's context with our look. `scale`: pixels per unit of the desktop.
void startInterface(float scale);
void endInterface();

// Draws everything for this frame and says in `session` where the picture goes.
void drawInterface(Ui& ui, Session& session, uvec2 window_px);

// Messages that stand over the picture now.
std::vector<std::string> viewportWarnings(const Session& session);

}  // namespace tessera::view
