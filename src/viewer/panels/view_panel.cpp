// What the picture shows.
#include "viewer/panels/panels.h"

namespace tessera::view
{

namespace
{

constexpr std::string_view kOptions[] = { "view", "shading" };

void draw(Ui& ui, Session& session)
{
	ui.option("view", session.options);
	ui.option("shading", session.options);
}

}  // namespace

const Panel kViewPanel = { "View", "what the picture shows", draw, kOptions };

}  // namespace tessera::view
