// The coarsest rate that keeps an error: `tessera render --max-error-px`.
#pragma once
#include "app/options.h"
#include "report/geometry_error.h"
#include "scene/camera.h"
#include "tables/table.h"

namespace tessera
{

struct FoundRate
{
	double rate = 0;           // pixels per segment
	report::RegionError seen;  // as measured there
	uint32_t tried = 0;        // rates that were measured
};

// Measures what the camera sees (report/geometry_error.h) at rates from 1/16 to 256 until one holds and none 10 % coarser does. Its largest
// error is at most 97 % of `max_error_px`: the rest is for what samples can miss. Errors: BadInput (nothing that is measured holds; it says
// how near the nearest came). A second or a few for each rate.
Result<FoundRate> rateForError(const BuiltScene& scene, const TessellationTable& table, const Camera& camera, const AppOptions& options,
							   double max_error_px);

}  // namespace tessera
