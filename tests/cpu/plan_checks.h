// Plans of all passes there are, and what tests ask of them.
#pragma once
#include "plan_inputs.h"

#include "frame/frame_resources.h"
#include "pipeline/passes.h"
#include "plan/plan.h"

#include <functional>
#include <initializer_list>

namespace tessera::test
{

inline constexpr std::string_view kWanted[] = { "picture", "counts", "heads" };

// Fails the test when there is none.
FramePlan planOf(const PlanInput& input);

// Of a plan's feature `name`, which must be known to it.
bool featureOn(const FramePlan& plan, std::string_view name);
const PlannedResource& resourceOf(const FramePlan& plan, std::string_view name);

void expectLeftOut(const FramePlan& plan, std::initializer_list<std::string_view> resources);
void expectKept(const FramePlan& plan, std::initializer_list<std::string_view> resources);
void expectDropped(const FramePlan& plan, std::initializer_list<std::string_view> passes);

// The rule itself, spelled out: whenever two steps touch a resource and one of them writes, a barrier lies between, back to the
// last write. Appends count as reads too.
bool everyConflictIsOrdered(const FramePlan& plan, const PlanInput& input);

// Lists and images start a frame empty: who reads one must come after who writes it. "shade reads visibility" where none does; "" when all is well.
std::string readBeforeWritten(const FramePlan& plan, const PlanInput& input);

// Calls `visit` with every combination of what plans depend on.
void forEveryInput(const std::function<void(const PlanInput&)>& visit);

}  // namespace tessera::test
