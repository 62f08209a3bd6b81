// What the user interface reports of itself, for scripts and tests: --ui-state FILE, written with F9 and at the end.
#pragma once
#include "viewer/session.h"
#include "viewer/ui.h"

#include <nlohmann/json.hpp>

namespace tessera::view
{

// `written`: how often it was written before.
nlohmann::ordered_json uiState(const Session& session, const Ui& ui, uint64_t written);

}  // namespace tessera::view
