#include "app/commands.h"
#include "app/scene_load.h"
#include "app/stats_json.h"
#include "app/suite_report.h"

#include <cstdio>

namespace tessera
{

namespace
{

// "extreme" or "extreme-quick", and behind a colon a family or a case.
Result<verify::SuiteRequest> requestFor(const CommandLine& line)
{
	verify::SuiteRequest request;
	const size_t colon = line.suite.find(':');
	const std::string name = line.suite.substr(0, colon);
	if (name != "extreme" && name != "extreme-quick")
		return fail(ExitCode::Usage, "--suite {}: extreme or extreme-quick is right, and behind a colon a family ({}) or a case", line.suite,
					fmt::join(verify::suiteFamilies(), ", "));
	if (!line.scene.empty() || !line.against.empty())
		return fail(ExitCode::Usage, "--suite {}: makes its own scenes; leave out SCENE and --against", line.suite);
	request.quick = name == "extreme-quick";
	request.only = colon == std::string::npos ? "" : line.suite.substr(colon + 1);
	request.seed = line.seed;
	request.usual_way = line.usual_way;
	request.fault = verify::faultNamed(line.inject);
	return request;
}

}  // namespace

Status suiteCommand(const CommandLine& line)
{
	TRY_ASSIGN(verify::SuiteRequest request, requestFor(line));
	TRY_ASSIGN(const TessellationTable table, loadChosenTable(line.options));
	TRY_ASSIGN(const std::unique_ptr<Device> device, Device::create({ line.options.device, line.options.validate }));
	request.device = device.get();
	request.table = &table;
	request.paths = line.options.raster == Raster::Auto ? verify::rasterPaths(*device) : std::vector{ line.options.raster };
	// One path is what a push has time for; the slow tests take every one.
	if (request.quick && line.options.raster == Raster::Auto)
		request.paths.resize(1);
	TRY_ASSIGN(const verify::SuiteReport report, verify::runSuite(request));
	if (line.stats != "-")
	{
		std::fputs(suiteTable(report, *device, line.usual_way).c_str(), stdout);
		std::fflush(stdout);
	}
	if (!line.stats.empty())
		TRY(writeJson(line.stats, suiteJson(report, *device, line.seed)));
	if (const size_t failed = report.failed(); failed > 0)
		return fail(ExitCode::CheckFailed, "verify: {} of {} cases of {} failed", failed, report.lines.size(), line.suite);
	if (const uint32_t count = device->validationMessages())
		return fail(ExitCode::CheckFailed, "--validate: the validation layer had {} messages", count);
	return {};
}

}  // namespace tessera
