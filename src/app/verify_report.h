// What verify found, for people and for programs.
#pragma once
#include "app/options.h"
#include "gpu/device.h"
#include "verify/verify.h"

namespace tessera
{

// A table of checks, what was looked at, and the place of each worst violation.
std::string verifyTable(const verify::Report& report, const Device& device, const BuiltScene& scene);

// "watertight 12, deterministic 3": the checks that are violated.
std::string violatedChecks(const verify::Report& report);

nlohmann::ordered_json verifyJson(const verify::Report& report, const Device& device, const BuiltScene& scene, const AppOptions& options,
								  uint64_t seed, const std::string& inject);

}  // namespace tessera
