#include "app/camera_path.h"
#include "app/commands.h"
#include "app/frame_budget.h"
#include "app/option_text.h"
#include "app/rate_for_error.h"
#include "app/scene_load.h"
#include "app/stats_json.h"
#include "base/log.h"
#include "frame/timed_frames.h"
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
	return fmt::format("the rate was coarsened: {:.4g} pixels per segment were asked for, {} ({}; --capacity and --budget make lists larger{})",
					   result.rate_wanted, granted, tightLists(result),
					   result.rays.clusters.built ? "; --max-cluster-data and --max-cluster-vertices those of rays" : "");
}

// The path of --camera-path, or the one camera.
Result<CameraPath> pathOf(const Camera& camera, const AppOptions& options)
{
	if (options.camera_path.empty())
		return CameraPath{ { { 0, camera } } };
	return readCameraPath(options.camera_path);
}

// "frame_0012.png" of "frame_####.png"; as it is without such signs.
std::string numbered(const std::string& path, uint32_t index)
{
	const size_t first = path.find('#');
	if (first == std::string::npos)
		return path;
	const size_t end = std::min(path.find_first_not_of('#', first), path.size());
	return fmt::format("{}{:0{}}{}", path.substr(0, first), index, end - first, path.substr(end));
}

void tellBudget(const BudgetOutcome& outcome)
{
	logInfo("--max-ms {:.4g}: {} of {} within a tenth of it, the longest {:.4g} ms; {:.4g} pixels per segment at the end, after {} to find the first "
			"rate",
			outcome.budget_ms, outcome.frames - outcome.over_tenth, counted(outcome.frames, "frame"), outcome.longest_ms, outcome.rate_px,
			counted(outcome.settling_frames, "frame"));
	if (outcome.over_tenth > 0 || !outcome.settled)
		logWarning("--max-ms {:.4g}: {} of {} took over a tenth more, the longest {:.4g} ms{}", outcome.budget_ms, outcome.over_tenth,
				   counted(outcome.frames, "frame"), outcome.longest_ms, outcome.settled ? "" : "; the rate did not come to rest before them");
}

// Draws the frames of a command: with a budget at its rates, otherwise, where the command asks for more than a picture, to be timed.
class FrameDrawing
{
public:
	FrameDrawing(Renderer& renderer, const AppOptions& options, FrameBudget* budget) : renderer_(renderer), options_(options), budget_(budget) {}

	// --warmup frames, and more until the rate rests or the device's clock does.
	Status warmUp(Device& device, const Camera& camera)
	{
		if (!budget_ && (options_.frames > 1 || options_.warmup > 0))
		{
			TRY_ASSIGN(load_, ClockLoad::create(device));
			timed_.emplace(renderer_, *load_);
		}
		for (uint32_t i = 0; i < options_.warmup || (timed_ && !timed_->isSettled()); ++i)
			TRY(draw(camera));
		return budget_ ? budget_->settle(camera) : Status();
	}

	Result<FrameResult> draw(const Camera& camera) { return timed_ ? timed_->draw(camera) : renderer_.renderFrame(camera); }
	Result<FrameResult> drawCounted(const Camera& camera) { return budget_ ? budget_->drawFrame(camera) : draw(camera); }

private:
	Renderer& renderer_;
	const AppOptions& options_;
	FrameBudget* budget_;
	std::unique_ptr<ClockLoad> load_;
	std::optional<TimedFrames> timed_;
};

// Draws --warmup frames from the path's start and --frames spread over it evenly, both ends included. Pictures of those before the last are written
// when `picture_path` tells them apart.
Result<FrameSeries> drawSeries(Renderer& renderer, Device& device, const Camera& camera, const AppOptions& options, FrameBudget* budget,
							   const std::string& picture_path)
{
	TRY_ASSIGN(const CameraPath path, pathOf(camera, options));
	FrameDrawing drawing(renderer, options, budget);
	TRY(drawing.warmUp(device, path.at(0)));
	FrameSeries series;
	for (uint32_t i = 0; i < options.frames; ++i)
	{
		const double time = options.frames > 1 ? path.duration_s() * i / (options.frames - 1) : 0;
		TRY_ASSIGN(const FrameResult result, drawing.drawCounted(path.at(time)));
		series.add(result);
		if (i + 1 < options.frames && picture_path.find('#') != std::string::npos)
		{
			TRY_ASSIGN(const std::vector<uint8_t> picture, renderer.readPicture());
			TRY(writePng(numbered(picture_path, i), options.width_px, options.height_px, picture, 4));
		}
	}
	return series;
}

// Says what was drawn. Errors: Coarsened, with --strict.
Status tellSeries(const FrameSeries& series, const AppOptions& options, const FrameBudget* budget)
{
	const FrameResult& last = series.last;
	logInfo("drew {}: {} of {} and {}, {:.3f} ms on the device", counted(options.frames, "frame"),
			counted(last.counts.micro_triangles, "micro-triangle"), counted(last.counts.part_triangles, "part triangle"),
			counted(last.counts.full_clusters, "full cluster"), series.frame.median());
	if (budget)
		tellBudget(budget->outcome());
	if (last.rounds > 1)
		logInfo("the frame was drawn in {} rounds: clusters exceed a list ({})", last.rounds, tightLists(last));
	if (isCoarsened(last) && options.strict)
		return fail(ExitCode::Coarsened, "--strict: {}", coarseningText(last));
	if (isCoarsened(last))
		logWarning("{}", coarseningText(last));
	return {};
}

nlohmann::ordered_json budgetJson(const BudgetOutcome& outcome)
{
	return { { "max_ms", outcome.budget_ms },
			 { "rate", outcome.rate_px },
			 { "settled", outcome.settled },
			 { "settling_frames", outcome.settling_frames },
			 { "frames", outcome.frames },
			 { "frames_within_a_tenth", outcome.frames - outcome.over_tenth },
			 { "longest_frame_ms", outcome.longest_ms },
			 { "frames_over_a_tenth_more", outcome.over_tenth } };
}

// Everything that needs the renderer, so that it is gone, and validated, when this returns.
// `found`: how the rate was found, when it was.
Status drawAndWrite(const CommandLine& line, const AppOptions& options, const std::optional<FoundRate>& found, const std::string& picture_path,
					const Subject& subject, Device& device)
{
	TRY_ASSIGN(const std::unique_ptr<Renderer> renderer, Renderer::create(device, subject.scene, subject.table, framePasses(), options));
	logInfo("drawing {}x{} at {} pixels per segment", options.width_px, options.height_px, options.rate);
	std::optional<FrameBudget> budget;
	if (options.max_ms)
		budget.emplace(*renderer, *options.max_ms, options.rate);
	FrameBudget* const kept = budget ? &*budget : nullptr;
	TRY_ASSIGN(const FrameSeries series, drawSeries(*renderer, device, subject.camera, options, kept, picture_path));
	TRY(tellSeries(series, options, kept));
	TRY_ASSIGN(const std::vector<uint8_t> picture, renderer->readPicture());
	const std::string last_path = numbered(picture_path, options.frames - 1);
	TRY(writePng(last_path, options.width_px, options.height_px, picture, 4));
	logInfo("wrote {}", last_path);
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
	if (budget)
		stats["budget"] = budgetJson(budget->outcome());
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
	if (options.max_ms && options.max_error_px)
		return fail(ExitCode::Usage, "--max-ms and --max-error-px: each finds the rate, give one of them");
	if (options.max_ms && device->limits.timestamp_ns == 0)
		return fail(ExitCode::DeviceCannot, "--max-ms: {} has no timers", device->name);
	if (options.max_ms)
		static_cast<RenderOptions&>(options) = budgetOptions(options, subject.scene, *device);
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
