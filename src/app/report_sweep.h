// Draws and measures every setting of a report, one renderer each, on one device.
#pragma once
#include "app/command_line.h"
#include "gpu/device.h"
#include "report/report_data.h"
#include "report/run_log.h"
#include "scene/scene.h"
#include "tables/table.h"

#include <filesystem>
#include <map>

namespace tessera
{

// What the sweep works on. All of it outlives the sweep.
struct SweepSubject
{
	const AppOptions& options;
	const BuiltScene& scene;
	const TessellationTable& table;
	Device& device;
	std::filesystem::path folder;  // of the report
	const report::WorldSurface* original = nullptr;
};

struct SweepResult
{
	std::vector<report::Run> runs;              // as in the log, those of other settings than were asked for left out
	std::map<std::string, std::string> closed;  // raster paths that the device cannot do, and why
};

// Draws every setting that the log does not have yet and adds it. A setting that fails becomes a failed run.
// Errors: those of files, of the camera, and of the reference picture; DeviceLost.
Result<SweepResult> runSweep(const SweepSubject& subject, report::RunLog& log);

// The options with this picture size.
AppOptions optionsFor(const AppOptions& options, const std::array<uint32_t, 2>& size);

}  // namespace tessera
