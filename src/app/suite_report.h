// What the extreme suite found, for people and for programs.
#pragma once
#include "gpu/device.h"
#include "verify/suite/suite.h"

#include <nlohmann/json.hpp>

namespace tessera
{

// A row per case: checks, worst value and its bound, error against the reference in double precision, run time; with the usual way's cracks
// and lost triangles where they were asked for. Then what went wrong, and what was skipped and why.
std::string suiteTable(const verify::SuiteReport& report, const Device& device, bool usual_way);

nlohmann::ordered_json suiteJson(const verify::SuiteReport& report, const Device& device, uint64_t seed);

}  // namespace tessera
