// What a report says of what the scene does not need: each pass, shader feature and resource that is left out, with bytes, and the time it would
// take.
#pragma once
#include "app/report_sweep.h"
#include "app/scene_plan.h"
#include "report/run_log.h"

namespace tessera
{

// Plans and measures at the report's first rate, metric, size and raster path that is open, from its first camera: every group of things that one
// condition keeps is forced on (plan/forced.h), in turn with frames in which nothing is, so that a device's changing clock meets all alike. The runs
// go to `log`; those that are there are not done again. With --measure-left-out off nothing is drawn. Errors: those of planning, of drawing without
// anything forced, and of files.
Status addLeftOut(const SweepSubject& subject, report::RunLog& log, report::ReportData& data);

}  // namespace tessera
