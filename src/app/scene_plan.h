// The plan of a scene's frame without drawing it: what `info --print-plan` shows.
#pragma once
#include "plan/plan.h"
#include "scene/camera.h"
#include "tables/table.h"

namespace tessera
{

struct ScenePlan
{
	PlanInput input;
	FramePlan plan;

	uint64_t bytesKept() const;
	uint64_t bytesSaved() const;
	uint64_t barriers() const;
};

// Plans the first attempt at a frame. Errors: those of listCapacities and planFrame.
Result<ScenePlan> planScene(const BuiltScene& scene, const Camera& camera, const RenderOptions& options, const DeviceTraits& device,
							const TessellationTable& table);

}  // namespace tessera
