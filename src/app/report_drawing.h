// Draws the frames of a report's run: along a camera path, warmed up, for as long as a run may take.
#pragma once
#include "app/options.h"
#include "frame/clock_load.h"
#include "frame/renderer.h"
#include "report/progress.h"
#include "report/run.h"

namespace tessera
{

// What a camera of the path was drawn at.
struct DrawnView
{
	View view;
	double rate_granted = 0;
};

// Draws --frames frames (24 when not asked for) after --warmup (8), shared out among `cameras` (at least one); fewer where that would take more than
// 30 seconds, but at least 3 of each. Fills in times, counts and what was granted. The first camera comes last: its picture is the one that stays.
// `load` fills the time between frames. Errors: those of Renderer::renderFrame.
Result<std::vector<DrawnView>> drawPath(Renderer& renderer, ClockLoad& load, std::span<const Camera> cameras, const AppOptions& options,
										report::Progress& progress, report::Run& run);

report::RunBytes bytesOf(const MemoryStats& memory);

}  // namespace tessera
