// --force: what is kept in a frame though nothing needs it, so that what leaving it out saves can be measured (DESIGN.md, C5).
#pragma once
#include "plan/plan.h"

namespace tessera
{

// Names that can be asked for: of all passes, shader features and resources.
std::vector<std::string_view> forceNames(std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources);

// What has to hold, and what has to be wanted, for everything that is named to be kept. A name that the frame needs anyway adds nothing; the order
// of the names does not matter. `wanted` as for planFrame; what `input` forces already does not count.
// Errors: Usage (an unknown name; something that cannot be forced with these options, and why); those of planFrame.
Result<Forced> forcedBy(std::span<const std::string> names, std::span<const PassDesc* const> passes, std::span<const ResourceDesc> resources,
						std::span<const std::string_view> wanted, const PlanInput& input);

}  // namespace tessera
