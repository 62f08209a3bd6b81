#include "app/report_sweep.h"

#include "app/list_options.h"
#include "app/scene_load.h"
#include "base/log.h"
#include "frame/renderer.h"
#include "output/png.h"
#include "pipeline/passes.h"
#include "report/heat.h"

#include <algorithm>
#include <chrono>

namespace tessera
{

using report::Run;
using report::Setting;

namespace
{

constexpr uint32_t kFrames = 24, kWarmup = 8;  // when not asked for
constexpr double kRunSeconds = 30;             // of drawing, for one run; at least kLeastFrames are drawn all the same
constexpr uint32_t kLeastFrames = 3;
constexpr uint64_t kMostMicroTriangles = 40'000'000;  // that are measured: about 6 GB
constexpr uint32_t kHeatWidth = 480;

double referenceRate(const AppOptions& options)
{
	double finest = 0;
	for (const double rate : ratesOf(options))
		if (rate > 0 && (finest == 0 || rate < finest))
			finest = rate;
	return options.reference_rate.value_or(finest > 0 ? finest / 2 : 1);
}

report::RunCounts countsOf(const FrameCountsRead& counts)
{
	return { counts.micro_triangles, counts.part_triangles,   counts.split_triangles,
			 counts.full_clusters,   counts.visible_clusters, counts.covered_pixels };
}

using PassTimes = std::vector<std::pair<std::string, std::vector<double>>>;  // by pass, in the frame's order

constexpr uint64_t report::RunCounts::*kCounts[] = { &report::RunCounts::micro_triangles,  &report::RunCounts::part_triangles,
													 &report::RunCounts::split_triangles,  &report::RunCounts::full_clusters,
													 &report::RunCounts::visible_clusters, &report::RunCounts::covered_pixels };

void addCounts(report::RunCounts& sum, const report::RunCounts& counts)
{
	for (const auto count : kCounts)
		sum.*count += counts.*count;
}

report::RunCounts meanCounts(report::RunCounts sum, uint64_t cameras)
{
	for (const auto count : kCounts)
		sum.*count /= cameras;
	return sum;
}

report::RunBytes bytesOf(const MemoryStats& memory)
{
	return { memory.lists, memory.geometry + memory.rays, memory.textures, memory.images };
}

std::string oneLine(std::string text)
{
	std::replace_if(
		text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
	return text;
}

// The same view of nothing: everything is nearer than its near distance.
Camera emptyView(const Camera& camera, const BuiltScene& scene)
{
	Camera empty = camera;
	const dvec3 reach = glm::max(glm::abs(scene.world_low - camera.eye), glm::abs(scene.world_high - camera.eye));
	empty.near_world = 4 * glm::length(reach) + nearDistance(camera, scene);
	return empty;
}

class Sweep
{
public:
	Sweep(const SweepSubject& subject, report::RunLog& log) : subject_(subject), log_(log), progress_(!subject.options.quiet) {}

	Result<SweepResult> run()
	{
		const auto sizes = sizesOf(subject_.options);
		const size_t count =
			sizes.size() * metricsOf(subject_.options).size() * ratesOf(subject_.options).size() * rastersOf(subject_.options).size();
		for (const auto& size : sizes)
		{
			AppOptions options = optionsFor(subject_.options, size);
			TRY_ASSIGN(cameras_, chooseCameras(subject_.scene, options));
			reference_picture_ = {};
			for (const Metric metric : metricsOf(subject_.options))
			{
				options.metric = metric;
				TRY(runMetric(options, count));
			}
		}
		return std::move(result_);
	}

private:
	Status runMetric(const AppOptions& options, size_t count)
	{
		// It goes by the metric. The surface that it describes does not, but what holds the one holds the other.
		surface_.reset();
		host_.emplace(subject_.scene, subject_.table, options.metric);
		for (const double rate : ratesOf(options))
			for (const Raster raster : rastersOf(options))
			{
				++number_;
				TRY(runOne(options, rate, raster, count));
			}
		return {};
	}

	Status runOne(const AppOptions& sized, double rate, Raster raster, size_t count)
	{
		const std::string raster_name(rasterName(raster));
		const Setting setting = { rate, raster_name, std::string(metricName(sized.metric)), sized.width_px, sized.height_px };
		if (const Run* done = log_.find(setting))
		{
			logInfo("[{}/{}] {}: is there already", number_, count, setting.label());
			result_.runs.push_back(*done);
			return {};
		}
		if (result_.closed.count(raster_name))
			return {};
		AppOptions options = sized;
		options.rate = static_cast<float>(rate);
		options.raster = raster;
		Run run;
		run.setting = setting;
		const Status status = measure(options, run);
		if (!status && status.error().code == ExitCode::DeviceLost)
			return status;
		if (!status && status.error().code == ExitCode::DeviceCannot)
		{
			result_.closed[raster_name] = oneLine(status.error().message);
			logWarning("raster path {} is closed here: {}", raster_name, status.error().message);
			return {};
		}
		if (!status)
			run.failure = oneLine(status.error().message);
		say(run, count);
		result_.runs.push_back(run);
		return log_.add(std::move(run));
	}

	void say(const Run& run, size_t count) const
	{
		if (!run.failure.empty())
		{
			logWarning("[{}/{}] {}: failed: {}", number_, count, run.setting.label(), run.failure);
			return;
		}
		std::string text = fmt::format("[{}/{}] {}: {} micro-triangles, {:.3f} ms", number_, count, run.setting.label(), run.counts.micro_triangles,
									   run.gpu_ms.median);
		if (run.surface)
			text += fmt::format(", error seen {:.3g} px (99th percentile; largest {:.3g})", run.surface->visible.px.p99, run.surface->visible.px.max);
		if (run.isCoarsened())
			text += fmt::format("; coarsened to rate {:.4g}", run.rate_granted);
		logInfo("{}", text);
	}

	Result<std::unique_ptr<Renderer>> rendererFor(const AppOptions& options)
	{
		return Renderer::create(subject_.device, subject_.scene, subject_.table, framePasses(), options);
	}

	// The picture of the last frame; covered where it is not the sky.
	Result<report::Picture> pictureOf(Renderer& renderer, const AppOptions& options) const
	{
		TRY_ASSIGN(std::vector<uint8_t> rgba, renderer.readPicture());
		report::Picture picture = { options.width_px, options.height_px, std::move(rgba), {} };
		if (sky_.size() == picture.rgba.size())
			for (size_t i = 0; i < picture.rgba.size(); i += 4)
				picture.covered.push_back(!std::equal(&picture.rgba[i], &picture.rgba[i] + 3, &sky_[i]));
		return picture;
	}

	// Made for the first run of a size that needs it.
	Status makeReference(const AppOptions& sized)
	{
		AppOptions options = sized;
		options.rate = static_cast<float>(rateOfReference(sized));
		options.raster = Raster::Auto;
		options.metric = Metric::Edge;
		TRY_ASSIGN(const std::unique_ptr<Renderer> renderer, rendererFor(options));
		TRY(renderer->renderFrame(emptyView(cameras_[0], subject_.scene)));
		TRY_ASSIGN(sky_, renderer->readPicture());
		TRY_ASSIGN(const FrameResult frame, renderer->renderFrame(cameras_[0]));
		TRY_ASSIGN(reference_picture_, pictureOf(*renderer, options));
		const std::string name = fmt::format("pictures/reference{}_{}x{}.png", options.rate, options.width_px, options.height_px);
		reference_ = { frame.rate_wanted, frame.rate_granted, frame.counts.micro_triangles, name };
		return writePng(subject_.folder / name, options.width_px, options.height_px, reference_picture_.rgba, 4);
	}

	// That of the runs that are there already: all of a size are to be compared with one picture.
	double rateOfReference(const AppOptions& sized) const
	{
		for (const Run& run : log_.runs())
			if (run.image && run.setting.width == sized.width_px && run.setting.height == sized.height_px)
				return run.reference.rate_wanted;
		return referenceRate(sized);
	}

	Status measure(const AppOptions& options, Run& run)
	{
		if (reference_picture_.rgba.empty())
			TRY(makeReference(options));
		run.reference = reference_;
		TRY_ASSIGN(const std::unique_ptr<Renderer> renderer, rendererFor(options));
		std::vector<DrawnView> views;
		TRY(drawPath(*renderer, options, run, views));
		TRY_ASSIGN(const report::Picture picture, pictureOf(*renderer, options));
		run.bytes = bytesOf(renderer->memory());
		run.image = report::compareImages(picture, reference_picture_);
		const std::string name =
			fmt::format("rate{}_{}_{}_{}x{}.png", run.setting.rate, run.setting.raster, run.setting.metric, options.width_px, options.height_px);
		run.picture = "pictures/" + name;
		TRY(writePng(subject_.folder / run.picture, options.width_px, options.height_px, picture.rgba, 4));
		return measureSurface(views, options, run);
	}

	// What a camera of the path was drawn at.
	struct DrawnView
	{
		View view;
		double rate_granted;
	};

	// The frames are shared out among the cameras; the first comes last, its picture is the one that is kept.
	Status drawPath(Renderer& renderer, const AppOptions& options, Run& run, std::vector<DrawnView>& views)
	{
		const size_t count = cameras_.size();
		run.cameras = static_cast<uint32_t>(count);
		std::vector<double> frame_ms;
		PassTimes pass_ms;
		report::RunCounts sum;
		views.resize(count);
		for (size_t i = count; i-- > 0;)
		{
			TRY_ASSIGN(const FrameResult last, drawFrames(renderer, options, cameras_[i], run, frame_ms, pass_ms));
			views[i] = { renderer.view(), last.rate_granted };
			addCounts(sum, countsOf(last.counts));
			run.rate_granted = std::max(run.rate_granted, last.rate_granted);
			run.every_factor_one = run.every_factor_one || last.every_factor_one;
			run.rounds = std::max(run.rounds, last.rounds);
		}
		run.counts = meanCounts(sum, count);
		run.gpu_ms = report::timeFigures(std::move(frame_ms));
		for (auto& [name, ms] : pass_ms)
			run.passes.push_back({ name, report::timeFigures(std::move(ms)) });
		return {};
	}

	// Warms up, then draws until there are enough frames or the camera's share of the run's time is over; gives the last.
	Result<FrameResult> drawFrames(Renderer& renderer, const AppOptions& options, const Camera& camera, Run& run, std::vector<double>& frame_ms,
								   PassTimes& pass_ms)
	{
		using Clock = std::chrono::steady_clock;
		const bool asked = options.frames > 1 || options.warmup > 0;
		const auto cameras = static_cast<uint32_t>(cameras_.size());
		const uint32_t frames = ((asked ? options.frames : kFrames) + cameras - 1) / cameras;
		const uint32_t warmup = ((asked ? options.warmup : kWarmup) + cameras - 1) / cameras;
		const auto start = Clock::now();
		const auto share = [&] {
			return std::chrono::duration<double>(Clock::now() - start).count() * cameras / kRunSeconds;
		};
		progress_.begin(fmt::format("drawing {}", run.setting.label()), warmup + frames);
		for (uint32_t i = 0; i < warmup && (i == 0 || share() < 0.25); ++i, ++run.warmup, progress_.advance())
			TRY(renderer.renderFrame(camera));
		FrameResult last;
		for (uint32_t i = 0; i < frames && (i < std::min(frames, kLeastFrames) || share() < 1); ++i, ++run.frames, progress_.advance())
		{
			TRY_ASSIGN(last, renderer.renderFrame(camera));
			frame_ms.push_back(last.gpu_ms);
			addPasses(last.passes, pass_ms);
		}
		progress_.end();
		return last;
	}

	static void addPasses(const std::vector<PassTime>& passes, PassTimes& pass_ms)
	{
		for (const PassTime& pass : passes)
		{
			auto found = std::find_if(pass_ms.begin(), pass_ms.end(), [&](const auto& entry) { return entry.first == pass.name; });
			if (found == pass_ms.end())
				found = pass_ms.insert(pass_ms.end(), { pass.name, {} });
			found->second.push_back(pass.gpu_ms);
		}
	}

	// Measured once per view and granted rate: raster paths draw the same micro-triangles.
	Status measureSurface(const std::vector<DrawnView>& views, const AppOptions& options, Run& run)
	{
		const auto same = std::find_if(result_.runs.begin(), result_.runs.end(), [&](const Run& other) {
			return other.surface && other.setting.metric == run.setting.metric && other.setting.width == run.setting.width &&
				   other.setting.height == run.setting.height && other.rate_granted == run.rate_granted &&
				   other.every_factor_one == run.every_factor_one;
		});
		if (same != result_.runs.end())
		{
			run.surface = same->surface;
			run.heat = same->heat;
			return {};
		}
		std::vector<report::SurfaceErrors> errors;
		for (size_t i = 0; i < views.size(); ++i)
		{
			const auto measured = errorsOf(views[i].view, options, run, i == 0);
			if (!measured)
			{
				logWarning("{}: its surface is not measured: {}", run.setting.label(), measured.error().message);
				return {};
			}
			errors.push_back(*measured);
		}
		run.surface = report::alongPath(errors);
		return {};
	}

	// `draws`: the picture of the errors too.
	Result<report::SurfaceErrors> errorsOf(const View& view, const AppOptions& options, Run& run, bool draws)
	{
		TRY_ASSIGN(const report::MicroScene micro, report::tessellate(*host_, view, options.max_split, kMostMicroTriangles));
		if (!surface_)
			surface_ = std::make_unique<report::ReferenceSurface>(*host_, view);
		const report::SurfacePair pair(*host_, view, *surface_, micro);
		const double diagonal = 2 * boundingRadius(subject_.scene);
		report::SurfaceErrors errors;
		errors.micro_triangles = micro.triangleCount();
		errors.reference_mesh_triangles = surface_->triangleCount();
		errors.visible = report::visibleError(pair, diagonal, {}, progress_);
		errors.whole = report::wholeSurfaceError(pair, diagonal, {}, progress_);
		report::includeSeen(errors.whole, errors.visible);
		errors.numerics = report::measureNumerics(*host_, view, micro);
		if (!draws)
			return errors;
		run.heat = fmt::format("pictures/error_rate{}_{}_{}x{}.png", run.rate_granted, run.setting.metric, options.width_px, options.height_px);
		const report::ErrorPicture heat = report::errorPicture(pair, kHeatWidth, progress_);
		TRY(writePng(subject_.folder / run.heat, heat.width, heat.height, report::heatColors(heat), 4));
		return errors;
	}

	const SweepSubject& subject_;
	report::RunLog& log_;
	std::optional<reference::HostScene> host_;
	report::Progress progress_;
	std::unique_ptr<report::ReferenceSurface> surface_;
	std::vector<Camera> cameras_;  // of the camera path, or the one that stands still
	std::vector<uint8_t> sky_;
	report::Picture reference_picture_;
	report::ReferencePicture reference_;
	SweepResult result_;
	size_t number_ = 0;
};

}  // namespace

AppOptions optionsFor(const AppOptions& options, const std::array<uint32_t, 2>& size)
{
	AppOptions sized = options;
	sized.width_px = size[0];
	sized.height_px = size[1];
	return sized;
}

Result<SweepResult> runSweep(const SweepSubject& subject, report::RunLog& log)
{
	return Sweep(subject, log).run();
}

}  // namespace tessera
