// What the viewer keeps between starts: how the window was left, not what it showed.
#pragma once
#include "viewer/session.h"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace tessera::view
{

// tessera/view.json in the user's configuration folder; empty when the system has none.
std::filesystem::path settingsFile();

nlohmann::ordered_json settingsJson(const Session& session, uvec2 window_px);

// Takes what is there and right, and leaves the rest as it is. Gives the window's size; {0, 0} when none was kept.
uvec2 applySettings(const nlohmann::ordered_json& json, Session& session);

// A missing or unreadable file is no settings.
nlohmann::ordered_json readSettings(const std::filesystem::path& file);

}  // namespace tessera::view
