// Options as text that reads back as the same: resetting one, and the command line that draws what the window shows. Pure.
#pragma once
#include "app/options.h"
#include "scene/camera.h"

namespace tessera::view
{

// As after giving `values` of this option on the command line and no others of it; no values: its default. Errors: those of setOption.
Result<AppOptions> withOption(const OptionDesc& option, const std::vector<std::string>& values, const AppOptions& options);

// What chooseCamera makes this camera of, whatever the scene's own are.
AppOptions withCamera(const AppOptions& options, const Camera& camera);

// "tessera render SCENE --eye ... ": everything that differs from the defaults and decides the picture, quoted for a shell. Run as it stands it
// gives the same picture, bit for bit.
std::string renderCommandLine(const std::string& scene, const AppOptions& options, const Camera& camera);

}  // namespace tessera::view
