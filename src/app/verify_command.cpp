#include "app/commands.h"
#include "app/option_text.h"
#include "app/scene_load.h"
#include "app/stats_json.h"
#include "app/verify_report.h"
#include "base/log.h"
#include "output/png.h"
#include "verify/leak_views.h"

#include <algorithm>
#include <cstdio>

namespace tessera
{

namespace
{

// The chosen camera, the scene's and random ones.
std::vector<verify::NamedCamera> camerasOf(const CommandLine& line, const Subject& subject)
{
	std::vector<verify::NamedCamera> cameras = { { "chosen", subject.camera } };
	const auto add = [&](const std::vector<verify::NamedCamera>& more) {
		for (const verify::NamedCamera& camera : more)
			if (!(camera.camera == subject.camera))
				cameras.push_back(camera);
	};
	add(verify::sceneCameras(subject.scene));
	add(verify::randomCameras(subject.scene, line.seed, line.random_cameras));
	return cameras;
}

Result<verify::Request> requestFor(const CommandLine& line, const Subject& subject, Device& device)
{
	if (subject.scene.instances.empty() || subject.scene.triangles.empty())
		return badInput("{}: there is nothing to verify, no instance has a triangle", subject.scene.path);
	verify::Request request;
	request.device = &device;
	request.scene = &subject.scene;
	request.table = &subject.table;
	AppOptions uncut = line.options;
	TRY(setOption(*findOption("cull"), "off", uncut));
	request.options = line.options;
	request.uncut_options = uncut;
	request.paths = line.options.raster == Raster::Auto ? verify::rasterPaths(device) : std::vector{ line.options.raster };
	request.cameras = line.leak_views > 0 ? verify::randomCameras(subject.scene, line.seed, line.leak_views) : camerasOf(line, subject);
	request.paints_violations = line.paints_violations;
	request.rates.assign(line.options.rates.begin(), line.options.rates.end());
	if (request.rates.empty())
		request.rates = { line.options.rate };
	request.seed = line.seed;
	request.fault = verify::faultNamed(line.inject);
	request.usual_way = line.usual_way;
	return request;
}

Status tell(const CommandLine& line, const Subject& subject, const Device& device, const verify::Report& report)
{
	if (line.stats != "-")
	{
		std::fputs(verifyTable(report, device, subject.scene).c_str(), stdout);
		std::fflush(stdout);
	}
	if (!line.output.empty())
	{
		TRY(writePng(line.output, line.options.width_px, line.options.height_px, report.picture, 4));
		logInfo("wrote {}: {}", line.output, report.picture_frame);
	}
	if (!line.stats.empty())
		TRY(writeJson(line.stats, verifyJson(report, device, subject.scene, line.options, line.seed, line.inject)));
	const std::string injected = line.inject.empty() ? "" : fmt::format(" (fault injected: {})", line.inject);
	if (report.violations() > 0)
		return fail(ExitCode::CheckFailed, "verify: {}: {}{}", subject.scene.path, violatedChecks(report), injected);
	if (!line.inject.empty())
		logWarning("the injected fault was not found: {}", report.injected.empty() ? "nothing is seen from these cameras" : report.injected);
	return {};
}

}  // namespace

Status verifyCommand(const CommandLine& line)
{
	if (!line.suite.empty())
		return suiteCommand(line);
	if (!line.output.empty() && !line.output.ends_with(".png"))
		return fail(ExitCode::Usage, "-o {}: pictures are written as .png", line.output);
	TRY_ASSIGN(const Subject subject, loadSubject(line.scene, line.options));
	TRY_ASSIGN(const std::unique_ptr<Device> device, Device::create({ line.options.device, line.options.validate }));
	logInfo("device {}, driver {}", device->name, device->driver);
	std::unique_ptr<Device> other;
	if (!line.against.empty())
	{
		TRY_ASSIGN(other, Device::create({ line.against, line.options.validate }));
		logInfo("against {}, driver {}", other->name, other->driver);
	}
	TRY_ASSIGN(verify::Request request, requestFor(line, subject, *device));
	request.other_device = other.get();
	TRY_ASSIGN(const verify::Report report, line.leak_views > 0 ? verify::runLeaks(request) : verify::run(request));
	TRY(tell(line, subject, *device, report));
	if (const uint32_t count = device->validationMessages() + (other ? other->validationMessages() : 0))
		return fail(ExitCode::CheckFailed, "--validate: the validation layer had {}", counted(count, "message"));
	return {};
}

}  // namespace tessera
