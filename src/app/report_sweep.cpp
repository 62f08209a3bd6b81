#include "app/report_sweep.h"

#include "app/busy_device.h"
#include "app/list_options.h"
#include "app/report_drawing.h"
#include "app/scene_load.h"
#include "base/log.h"
#include "frame/renderer.h"
#include "output/png.h"
#include "pipeline/passes.h"
#include "report/heat.h"

#include <algorithm>

namespace tessera
{

using report::Run;
using report::Setting;

namespace
{

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

std::string joined(const std::vector<std::string>& names)
{
	return fmt::format("{}", fmt::join(names, "+"));
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
	Sweep(const SweepSubject& subject, report::RunLog& log)
		: subject_(subject), log_(log), progress_(!subject.options.quiet), diagonal_(2 * boundingRadius(subject.scene))
	{
		if (subject.original)
			original_.emplace(*subject.original, diagonal_);
	}

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
		const Setting setting = { rate, raster_name, std::string(metricName(sized.metric)), sized.width_px, sized.height_px, joined(sized.forced) };
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
		if (run.surface && run.surface->original)
			text += fmt::format("; {:.3g} from the original (root mean square, world units; the reference surface {:.3g})",
								run.surface->original->drawn.world.rms, run.surface->original->floor.world.rms);
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
		if (!load_)
		{
			TRY_ASSIGN(load_, ClockLoad::create(subject_.device));
		}
		if (reference_picture_.rgba.empty())
			TRY(makeReference(options));
		run.reference = reference_;
		TRY_ASSIGN(const std::unique_ptr<Renderer> renderer, rendererFor(options));
		TRY_ASSIGN(const std::vector<DrawnView> views, drawPath(*renderer, *load_, cameras_, options, progress_, run));
		TRY_ASSIGN(const report::Picture picture, pictureOf(*renderer, options));
		run.bytes = bytesOf(renderer->memory());
		const BusyDevice busy(*renderer, cameras_[0]);
		run.image = report::compareImages(picture, reference_picture_);
		const std::string name =
			fmt::format("rate{}_{}_{}_{}x{}.png", run.setting.rate, run.setting.raster, run.setting.metric, options.width_px, options.height_px);
		run.picture = "pictures/" + name;
		TRY(writePng(subject_.folder / run.picture, options.width_px, options.height_px, picture.rgba, 4));
		return measureSurface(views, options, run);
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
		report::SurfaceErrors errors;
		TRY(againstReference(view, micro, options, run, draws, errors));
		if (original_)
			errors.original = original_->measure(*host_, view, *surface_, micro, progress_);
		return errors;
	}

	Status againstReference(const View& view, const report::MicroScene& micro, const AppOptions& options, Run& run, bool draws,
							report::SurfaceErrors& errors)
	{
		const report::SurfacePair pair(*host_, view, *surface_, micro);
		errors.micro_triangles = micro.triangleCount();
		errors.reference_mesh_triangles = surface_->triangleCount();
		errors.visible = report::visibleError(pair, diagonal_, {}, progress_);
		errors.whole = report::wholeSurfaceError(pair, diagonal_, {}, progress_);
		report::includeSeen(errors.whole, errors.visible);
		errors.numerics = report::measureNumerics(*host_, view, micro);
		if (!draws)
			return {};
		run.heat = fmt::format("pictures/error_rate{}_{}_{}x{}.png", run.rate_granted, run.setting.metric, options.width_px, options.height_px);
		const report::ErrorPicture heat = report::errorPicture(pair, kHeatWidth, progress_);
		return writePng(subject_.folder / run.heat, heat.width, heat.height, report::heatColors(heat), 4);
	}

	const SweepSubject& subject_;
	report::RunLog& log_;
	std::optional<reference::HostScene> host_;
	report::Progress progress_;
	std::unique_ptr<ClockLoad> load_;
	double diagonal_;  // of the scene's bounds, world units
	std::optional<report::OriginalMeasure> original_;
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
