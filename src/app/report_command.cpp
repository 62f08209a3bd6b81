#include "app/commands.h"
#include "app/left_out.h"
#include "app/list_options.h"
#include "app/option_text.h"
#include "app/report_sweep.h"
#include "app/scene_load.h"
#include "app/scene_plan.h"
#include "app/stats_json.h"
#include "base/log.h"
#include "frame/renderer.h"
#include "report/metric_fronts.h"
#include "report/page_original.h"

#include <algorithm>

namespace tessera
{

namespace
{

constexpr std::string_view kFreeOptions[] = { "size",   "rate",  "raster", "rates", "rasters", "sizes",   "max_error_px", "max_ms",
											  "resume", "quiet", "strict", "view",  "metric",  "metrics", "force",        "measure_left_out" };

Status checkOptions(const AppOptions& options)
{
	if (options.view != ViewMode::Shaded)
		return fail(ExitCode::Usage, "report: pictures are compared as --view shaded alone");
	const auto isAutomatic = [](Raster raster) {
		return raster == Raster::Auto;
	};
	if (!options.original.empty() && options.grid_columns * options.grid_rows > 1)
		return fail(ExitCode::Usage, "--original: stands once, --grid {}x{} asks for copies of the scene; leave one of them out",
					options.grid_columns, options.grid_rows);
	if (options.rasters.size() > 1 && std::any_of(options.rasters.begin(), options.rasters.end(), isAutomatic))
		return fail(ExitCode::Usage, "--rasters: auto is one of the others; it can only stand alone");
	return {};
}

// What all runs of a log must have in common: a change of anything else adds runs.
nlohmann::json factsOf(const CommandLine& line, const BuiltScene& scene, const Device& device, const std::optional<report::WorldSurface>& original)
{
	nlohmann::json options = optionsJson(line.options);
	for (const std::string_view name : kFreeOptions)
		options.erase(std::string(name));
	nlohmann::json facts;
	facts["scene"] = sceneJson(scene);
	facts["device"] = { { "name", device.name }, { "driver", device.driver }, { "api", device.api } };
	facts["options"] = options;
	facts["version"] = TESSERA_VERSION;
	if (original)
		facts["original"] = { { "triangles", original->triangleCount() }, { "area", original->area() } };
	return facts;
}

// Words as a shell takes them.
std::string quoted(const std::string& word)
{
	constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+.,:/@%";
	if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos)
		return word;
	std::string text = "'";
	for (const char c : word)
		text += c == '\'' ? std::string("'\\''") : std::string(1, c);
	return text + "'";
}

// What was given. --resume is not needed to do it again.
std::string commandOf(const CommandLine& line, const BuiltScene& scene)
{
	std::string text = "tessera report " + quoted(scene.path);
	for (const OptionDesc& option : optionTable())
	{
		const std::vector<std::string> values = printOption(option, line.options);
		if (option.name == "resume" || option.name == "quiet" || values == printOption(option, AppOptions()))
			continue;
		for (const std::string& value : values)
			text += fmt::format(" --{}{}{}", option.name, value.empty() ? "" : " ", value.empty() ? "" : quoted(value));
	}
	return text + " -o " + quoted(line.output.empty() ? "report" : line.output);
}

std::vector<std::pair<std::string, std::string>> sceneFacts(const BuiltScene& scene, const AppOptions& options)
{
	std::vector<std::pair<std::string, std::string>> facts = {
		{ "base triangles", fmt::format("{} ({} over {})", scene.traits.base_triangles, scene.traits.instanced_triangles,
										counted(scene.instances.size(), "instance")) },
		{ "height maps", fmt::format("{}", scene.height_maps.size()) },
		{ "diagonal of the bounds", fmt::format("{:.6g}", 2 * boundingRadius(scene)) },
	};
	if (!options.camera_path.empty())
		facts.emplace_back(
			"camera path",
			options.camera_path +
				": errors are the largest, mean or root mean square over its keys, times those of frames at all of them; pictures are of the first");
	for (const auto& size : sizesOf(options))
		if (const Result<Camera> camera = chooseCamera(scene, optionsFor(options, size)))
			facts.emplace_back(fmt::format("camera, {}x{}", size[0], size[1]),
							   fmt::format("eye {}, target {}, {}", printVector(camera->eye), printVector(camera->target),
										   camera->orthographic ? fmt::format("orthographic, {} high", camera->height_world)
																: fmt::format("{:.4g} degrees", glm::degrees(camera->fov_y_rad))));
	return facts;
}

Result<report::ReportData> dataOf(const CommandLine& line, const BuiltScene& scene, const Device& device, SweepResult&& sweep, nlohmann::json facts)
{
	report::ReportData data;
	data.scene = scene.path;
	data.command = commandOf(line, scene);
	data.version = TESSERA_VERSION;
	data.device = device.name;
	data.driver = device.driver;
	data.api = device.api;
	data.facts = std::move(facts);
	data.scene_facts = sceneFacts(scene, line.options);
	data.runs = std::move(sweep.runs);
	data.closed = std::move(sweep.closed);
	data.limits = { line.options.max_error_px, line.options.max_ms };
	return data;
}

// The model of --original, if there is one.
Result<std::optional<report::WorldSurface>> loadOriginal(const AppOptions& options, const BuiltScene& scene)
{
	if (options.original.empty())
		return std::optional<report::WorldSurface>();
	if (scene.traits.instanced_triangles > report::kMostBaseTriangles)
		return badInput("--original: {} has {} triangles over its instances; at most {} are measured against an original", scene.path,
						scene.traits.instanced_triangles, report::kMostBaseTriangles);
	const Result<ImportedScene> model = importScene(options.original, {});
	if (!model)
		return fail(model.error().code, "--original: {}", model.error().message);
	Result<report::WorldSurface> surface = report::originalSurface(*model);
	if (!surface)
		return fail(surface.error().code, "--original: {}", surface.error().message);
	if (glm::any(glm::lessThan(surface->high(), scene.world_low)) || glm::any(glm::greaterThan(surface->low(), scene.world_high)))
		logWarning("--original: {} lies apart from {}, from {} to {}: have the two one coordinate system?", options.original, scene.path,
				   printVector(surface->low()), printVector(surface->high()));
	return std::optional(std::move(*surface));
}

Status measureAndWrite(const CommandLine& line, const BuiltScene& scene, const TessellationTable& table, Device& device,
					   const std::optional<report::WorldSurface>& original)
{
	const std::filesystem::path folder = line.output.empty() ? "report" : line.output;
	const nlohmann::json facts = factsOf(line, scene, device, original);
	const std::filesystem::path log_path = folder / "runs.jsonl";
	TRY_ASSIGN(report::RunLog log, line.options.resume ? report::RunLog::resume(log_path, facts) : report::RunLog::start(log_path, facts));
	const SweepSubject subject = { line.options, scene, table, device, folder, original ? &*original : nullptr };
	TRY_ASSIGN(SweepResult sweep, runSweep(subject, log));
	const bool drew = std::any_of(sweep.runs.begin(), sweep.runs.end(), [](const report::Run& run) { return run.failure.empty(); });
	if (!drew)
		return fail(sweep.runs.empty() ? ExitCode::DeviceCannot : ExitCode::BadInput, "report: nothing could be drawn: {}",
					sweep.runs.empty() ? sweep.closed.begin()->second : sweep.runs[0].failure);
	TRY_ASSIGN(report::ReportData data, dataOf(line, scene, device, std::move(sweep), facts));
	if (original)
		data.original = { line.options.original, original->triangleCount() };
	TRY(addLeftOut(subject, log, data));
	TRY(report::writeReport(folder, data));
	for (const report::Advice& advice : report::recommend(data.runs, data.limits))
		logInfo("{}", advice.text);
	for (const report::Cost cost : { report::Cost::Time, report::Cost::Triangles })
		for (const report::MetricComparison& comparison : report::compareMetrics(data.runs, report::ErrorKind::SeenP99, cost))
			logInfo("{}", report::describe(comparison, report::ErrorKind::SeenP99));
	for (const std::string& sentence : report::describeOriginal(data))
		logInfo("{}", sentence);
	logInfo("wrote {}", (folder / "report.html").string());
	return {};
}

}  // namespace

Status reportCommand(const CommandLine& line)
{
	TRY(checkOptions(line.options));
	TRY_ASSIGN(const TessellationTable table, loadChosenTable(line.options));
	TRY_ASSIGN(const BuiltScene scene, loadScene(line.scene, line.options));
	TRY(chooseCamera(scene, line.options));
	TRY_ASSIGN(const std::optional<report::WorldSurface> original, loadOriginal(line.options, scene));
	TRY_ASSIGN(const std::unique_ptr<Device> device, Device::create({ .name = line.options.device, .validate = line.options.validate }));
	logInfo("device {}, driver {}", device->name, device->driver);
	if (device->limits.timestamp_ns <= 0)
		return fail(ExitCode::DeviceCannot, "{}: has no timestamps, GPU times cannot be measured", device->name);
	TRY(measureAndWrite(line, scene, table, *device, original));
	if (const uint32_t count = device->validationMessages())
		return fail(ExitCode::CheckFailed, "--validate: the validation layer had {}", counted(count, "message"));
	return {};
}

}  // namespace tessera
