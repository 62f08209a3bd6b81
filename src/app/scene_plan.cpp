#include "app/scene_plan.h"

#include "frame/frame_resources.h"
#include "frame/renderer.h"
#include "pipeline/passes.h"
#include "plan/forced.h"

#include <algorithm>

namespace tessera
{

namespace
{

uint64_t sumBytes(const FramePlan& plan, bool kept)
{
	uint64_t sum = 0;
	for (const PlannedResource& resource : plan.resources)
		sum += resource.kept == kept ? resource.bytes : 0;
	return sum;
}

}  // namespace

uint64_t ScenePlan::bytesKept() const
{
	return sumBytes(plan, true);
}

uint64_t ScenePlan::bytesSaved() const
{
	return sumBytes(plan, false);
}

uint64_t ScenePlan::barriers() const
{
	return static_cast<uint64_t>(std::count_if(plan.steps.begin(), plan.steps.end(), [](const PlanStep& step) { return !step.wait_for.empty(); }));
}

Result<ScenePlan> planScene(const BuiltScene& scene, const Camera& camera, const RenderOptions& options, const DeviceTraits& device,
							const TessellationTable& table)
{
	ScenePlan planned;
	planned.input = { options, scene.traits, sizesOf(scene, table), device, {}, {} };
	TRY(listCapacities(planned.input));
	ViewRequest request = { options.width_px, options.height_px };
	request.rate_px = double(options.rate);
	request.displacement_scale = options.displacement_scale;
	request.displacement_offset = options.displacement_offset;
	request.metric = options.metric;
	const uint32_t max_split = std::min(options.max_split, table.max_edge_segments);
	const FactorBound bound = boundFactors(camera, scene, request, table.max_edge_segments, max_split);
	planned.input.view.factors_above_one = bound.above_one;
	planned.input.view.split_levels = bound.split_levels;
	TRY_ASSIGN(const View view, makeView(camera, scene, request));
	planned.input.view.shares_structures = planned.input.view.makes_structures =
		std::ranges::any_of(meshesThatShare(scene, view, planned.input), [](uint8_t shares) { return shares != 0; });
	TRY_ASSIGN(planned.input.forced, forcedBy(options.forced, framePasses(), resourceDescs(), kWantedOutputs, planned.input));
	TRY_ASSIGN(planned.plan, planFrame(framePasses(), resourceDescs(), kWantedOutputs, planned.input));
	return planned;
}

}  // namespace tessera
