#include "app/commands.h"
#include "app/option_text.h"
#include "app/rate_for_error.h"
#include "app/scene_load.h"
#include "app/stats_json.h"
#include "base/log.h"
#include "frame/renderer.h"
#include "output/png.h"
#include "pipeline/passes.h"

#include <algorithm>

namespace tessera
{

namespace
{

Result<std::string> picturePath(const CommandLine& line)
{
	const std::string path = line.output.empty() ? "tessera.png" : line.output;
	if (!path.ends_with(".png") && !path.ends_with(".PNG"))
		return fail(ExitCode::Usage, "-o {}: pictures are written as .png", path);
	return path;
}

bool isCoarsened(const FrameResult& result)
{
	return result.coarsening > 0 || result.every_factor_one;
}

// "part_triangles wanted 3000000 and holds 1048576": every list that made the frame coarser.
std::string tightLists(const FrameResult& result)
{
	std::string text;
	for (const ListStats& list : result.lists)
		if (list.peak > list.capacity)
			text += fmt::format("{}{} wanted {} and holds {}", text.empty() ? "" : ", ", list.name, list.peak, list.capacity);
	return text;
}

std::string coarseningText(const FrameResult& result)
{
	const std::string granted = result.every_factor_one ? "every factor is 1" : fmt::format("{:.4g} was granted", result.rate_granted);
	return fmt::format("the rate was coarsened: {:.4g} pixels per segment were asked for, {} ({}; --capacity and --budget make lists larger)",
					   result.rate_wanted, granted, tightLists(result));
}

Result<FrameSeries> drawFrames(Renderer& renderer, const Camera& camera, const AppOptions& options)
{
	FrameSeries series;
	for (uint32_t i = 0; i < options.warmup; ++i)
		TRY(renderer.renderFrame(camera));
	for (uint32_t i = 0; i < options.frames; ++i)
	{
		TRY_ASSIGN(const FrameResult result, renderer.renderFrame(camera));
		series.add(result);
	}
	const FrameResult& last = series.last;
	logInfo("drew {}: {} of {} and {}, {:.3f} ms on the device", counted(options.frames, "frame"),
			counted(last.counts.micro_triangles, "micro-triangle"), counted(last.counts.part_triangles, "part triangle"),
			counted(last.counts.full_clusters, "full cluster"), series.frame.median());
	if (last.rounds > 1)
		logInfo("the frame was drawn in {} rounds: clusters exceed a list ({})", last.rounds, tightLists(last));
	if (isCoarsened(last) && options.strict)
		return fail(ExitCode::Coarsened, "--strict: {}", coarseningText(last));
	if (isCoarsened(last))
		logWarning("{}", coarseningText(last));
	return series;
}

// Everything that needs the renderer, so that it is gone, and validated, when this returns.
// `found`: how the rate was found, when it was.
Status drawAndWrite(const CommandLine& line, const AppOptions& options, const std::optional<FoundRate>& found, const std::string& picture_path,
					const Subject& subject, Device& device)
{
	TRY_ASSIGN(const std::unique_ptr<Renderer> renderer, Renderer::create(device, subject.scene, subject.table, framePasses(), options));
	logInfo("drawing {}x{} at {} pixels per segment", options.width_px, options.height_px, options.rate);
	TRY_ASSIGN(const FrameSeries series, drawFrames(*renderer, subject.camera, options));
	TRY_ASSIGN(const std::vector<uint8_t> picture, renderer->readPicture());
	TRY(writePng(picture_path, options.width_px, options.height_px, picture, 4));
	logInfo("wrote {}", picture_path);
	if (line.stats.empty())
		return {};
	const RunFacts facts = { device, subject.scene, options, subject.camera, renderer->plan(), renderer->planInput(), series, renderer->memory() };
	nlohmann::ordered_json stats = statsJson(facts);
	if (found)
		stats["error"] = { { "seen_max_px", found->seen.px.max },
						   { "seen_p99_px", found->seen.px.p99 },
						   { "seen_rms_px", found->seen.px.rms },
						   { "samples", found->seen.samples },
						   { "rates_tried", found->tried } };
	TRY(writeJson(line.stats, stats));
	if (line.stats != "-")
		logInfo("wrote {}", line.stats);
	return {};
}

}  // namespace

Status renderCommand(const CommandLine& line)
{
	TRY_ASSIGN(const std::string picture_path, picturePath(line));
	TRY_ASSIGN(const Subject subject, loadSubject(line.scene, line.options));
	TRY_ASSIGN(const std::unique_ptr<Device> device,
			   Device::create({ line.options.device, line.options.validate, line.options.pipeline_statistics }));
	logInfo("device {}, driver {}", device->name, device->driver);
	AppOptions options = line.options;
	std::optional<FoundRate> found;
	if (options.max_error_px)
	{
		TRY_ASSIGN(found, rateForError(subject.scene, subject.table, subject.camera, options, *options.max_error_px));
		options.rate = static_cast<float>(found->rate);
		logInfo("rate {:.4g} keeps the error seen at or below {:.3g} px", found->rate, found->seen.px.max);
	}
	TRY(drawAndWrite(line, options, found, picture_path, subject, *device));
	if (const uint32_t count = device->validationMessages())
		return fail(ExitCode::CheckFailed, "--validate: the validation layer had {}", counted(count, "message"));
	return {};
}

}  // namespace tessera
