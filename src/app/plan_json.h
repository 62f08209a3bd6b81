// A plan as JSON and as text.
#pragma once
#include "app/scene_plan.h"

#include <nlohmann/json.hpp>

namespace tessera
{

nlohmann::ordered_json planJson(const ScenePlan& planned);

// Passes in order with their barriers, then what is left out and why, then resources with their bytes.
std::string planText(const ScenePlan& planned);

}  // namespace tessera
