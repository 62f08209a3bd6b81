// What the device said of a round that it has drawn, as numbers of the frame.
#pragma once
#include "frame/frame_resources.h"
#include "frame/occlusion_controller.h"
#include "frame/pass_runner.h"

namespace tessera
{

// Adds the round's times per pass, counts and, from its last round, what a frame has once.
void addTimes(const PassRunner& runner, const FramePlan& plan, FrameResult& result);
void addCounts(const FrameResources& resources, FrameCountsRead& sum);

// Wanted, capacity and peaks of every list there is.
void fillLists(const FrameResources& resources, FrameResult& result);

// Packings that the last frame nearly filled grow before they are too small, so that a moving camera seldom draws a frame twice.
void growNearlyFull(FrameResources& resources, const PlanInput& input);

// Lists of which more was wanted than they hold.
struct OverfullLists
{
	bool grew = false;         // one of them holds enough now
	bool of_clusters = false;  // one of them holds clusters: no rate helps
};
OverfullLists growOverfull(FrameResources& resources, const PlanInput& input);

// What looking for hidden parts found in this frame, and what it took.
OcclusionOutcome occlusionOutcome(const FrameResult& result);

}  // namespace tessera
