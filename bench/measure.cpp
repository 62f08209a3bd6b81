#include "bench/measure.h"

#include "app/option_text.h"
#include "app/scene_load.h"
#include "base/file.h"
#include "frame/timed_frames.h"
#include "pipeline/passes.h"

#include <new>

namespace tessera::bench
{

namespace fs = std::filesystem;

namespace
{

std::string oneLine(std::string text)
{
	for (char& c : text)
		c = c == '\n' || c == '\r' ? ' ' : c;
	return text;
}

// bench/scenes of the checkout that the program was built in, or of where it is installed.
Result<fs::path> findScenes(const Settings& settings)
{
	std::error_code code;
	if (!settings.scenes.empty())
	{
		if (!fs::is_directory(settings.scenes, code))
			return badInput("--scenes {}: there is no such folder", settings.scenes);
		return fs::path(settings.scenes);
	}
	const fs::path program = programFolder();
	for (fs::path folder = program; !folder.empty(); folder = folder.parent_path())
	{
		for (const char* below : { "bench/scenes", "share/tessera/bench/scenes" })
			if (fs::is_regular_file(folder / below / "sphere.gltf", code))
				return folder / below;
		if (folder == folder.root_path())
			break;
	}
	return badInput("{}: no folder above it has bench/scenes; --scenes FOLDER says where they are", program.string());
}

struct LoadedScene
{
	std::string key;  // what it was loaded from
	Result<BuiltScene> scene;
};

class DeviceBench final : public Bench
{
public:
	explicit DeviceBench(const Settings& settings) : settings_(settings) {}

	Status initialize()
	{
		TRY_ASSIGN(scenes_, findScenes(settings_));
		TRY_ASSIGN(table_, loadChosenTable(settings_.base));
		TRY(makeDevice());
		if (device_->limits.timestamp_ns <= 0)
			return fail(ExitCode::DeviceCannot, "{}: has no timestamps, GPU times cannot be measured", device_->name);
		results_.device = fmt::format("{}, driver {}", device_->name, device_->driver);
		return loadPeer();
	}

	Status run(const std::vector<Case>& cases, const std::function<Status(const Measurements&)>& after_row) override
	{
		for (size_t i = 0; i < cases.size(); ++i)
		{
			if (results_.closed.count(cases[i].raster))
				continue;
			if (std::optional<Row> row = measureCase(cases[i]))
			{
				report(*row, i + 1, cases.size());
				results_.rows.push_back(std::move(*row));
			}
			else
				fmt::print(stderr, "raster path {} is closed here: {}\n", cases[i].raster, results_.closed[cases[i].raster]);
			TRY(after_row(results_));
		}
		return {};
	}

	const Measurements& measurements() const override { return results_; }
	uint32_t validationMessages() const override { return messages_ + (device_ ? device_->validationMessages() : 0); }

private:
	void dropDevice()
	{
		if (device_)
			messages_ += device_->validationMessages();
		clock_load_.reset();
		device_.reset();
	}

	Status makeDevice()
	{
		TRY_ASSIGN(device_, Device::create({ settings_.base.device, settings_.base.validate, settings_.base.pipeline_statistics }));
		TRY_ASSIGN(clock_load_, ClockLoad::create(*device_));
		return {};
	}

	Status loadPeer()
	{
		const fs::path beside = fs::absolute(scenes_).lexically_normal();
		const fs::path folder = beside.has_filename() ? beside.parent_path() : beside.parent_path().parent_path();
		fs::path path = settings_.peer;
		if (settings_.peer.empty())
			path = folder / (device_->is_cpu ? "peer_lavapipe.csv" : "peer_h100.csv");
		std::error_code code;
		if (settings_.peer.empty() && !fs::exists(path, code))
		{
			fmt::print(stderr, "warning: {}: there is no such file, nothing is compared with the peer\n", path.string());
			return {};
		}
		TRY_ASSIGN(const CsvTable csv, readCsv(path.string()));
		TRY_ASSIGN(peer_, peerTable(csv, path.string()));
		results_.peer_device = peer_.device;
		return {};
	}

	const Result<BuiltScene>& sceneOf(const Case& what)
	{
		const bool builtin = what.path.starts_with("builtin:");
		const std::string path = builtin ? what.path : (scenes_ / what.path).string();
		const std::string key = fmt::format("{} {}x{}", path, what.options.grid_columns, what.options.grid_rows);
		if (!loaded_ || loaded_->key != key)
		{
			loaded_.reset();  // before the next is loaded: both may not fit
			loaded_ = { key, loadScene(path, what.options) };
		}
		return loaded_->scene;
	}

	// Warms up until the device has settled, then draws frames until there are enough or the row's time is over; at least one.
	Status drawFrames(Renderer& renderer, const Camera& camera, Row& row) const
	{
		constexpr double kWarmupShare = 0.25;
		TimedFrames timed(renderer, *clock_load_);
		const auto isWarm = [&](uint32_t frames) {
			return timed.seconds() >= settings_.row_seconds * kWarmupShare || (frames >= row.what.options.warmup && timed.isSettled());
		};
		for (uint32_t i = 0; !isWarm(i); ++i)
			TRY(timed.draw(camera));
		for (uint32_t i = 0; i < row.what.options.frames && (i == 0 || timed.seconds() < settings_.row_seconds); ++i)
		{
			TRY_ASSIGN(const FrameResult result, timed.draw(camera));
			row.frames.add(result);
		}
		return {};
	}

	// Also says through `closed` that the raster path's gate is closed on this device.
	Status draw(Row& row, bool& closed)
	{
		if (!device_)
			TRY(makeDevice());
		const Result<BuiltScene>& scene = sceneOf(row.what);
		if (!scene)
			return tl::unexpected(scene.error());
		TRY_ASSIGN(const Camera camera, chooseCamera(*scene, row.what.options));
		auto renderer = Renderer::create(*device_, *scene, table_, framePasses(), row.what.options);
		if (!renderer)
		{
			closed = renderer.error().code == ExitCode::DeviceCannot;
			return tl::unexpected(renderer.error());
		}
		TRY(drawFrames(**renderer, camera, row));
		row.memory = (*renderer)->memory();
		return {};
	}

	Status drawCatching(Row& row, bool& closed)
	{
		try
		{
			return draw(row, closed);
		}
		catch (const std::bad_alloc&)
		{
			return badInput("out of memory");
		}
	}

	// Nothing when the raster path is closed on this device.
	std::optional<Row> measureCase(const Case& what)
	{
		Row row;
		row.what = what;
		if (const std::optional<double> px = peerPixels(shortest(what.options.rate)))
			if (const PeerTime* time = peer_.find(what.sceneLabel(), what.options.width_px, what.options.height_px, *px))
				row.peer = *time;
		bool closed = false;
		const Status status = drawCatching(row, closed);
		if (!status && closed)
		{
			results_.closed[what.raster] = oneLine(status.error().message);
			return std::nullopt;
		}
		if (!status)
		{
			row.frames = {};
			row.error = oneLine(status.error().message);
			if (status.error().code == ExitCode::DeviceLost)
				dropDevice();  // made anew for the next row
			return row;
		}
		const FrameResult& last = row.frames.last;
		row.state = last.every_factor_one || last.rate_granted > last.rate_wanted ? RowState::Coarsened : RowState::Measured;
		return row;
	}

	void report(const Row& row, size_t number, size_t count) const
	{
		if (settings_.base.quiet)
			return;
		std::string text = fmt::format("[{}/{}] {}: ", number, count, row.what.label());
		if (row.state == RowState::Failed)
			text += "failed: " + row.error;
		else
			text += fmt::format("{:.3f} Mtri, {:.3f} ms ({:.3f} to {:.3f})", double(row.frames.last.counts.micro_triangles) * 1e-6, row.medianMs(),
								row.frames.frame.least(), row.frames.frame.most());
		if (row.state == RowState::Coarsened)
			text += fmt::format(", coarsened to rate {:.4g}: does not count", row.frames.last.rate_granted);
		if (row.speedUp())
			text += fmt::format(", peer {} ms{}: {:.2f}x", row.peer->gpu_ms, row.peer->overflow ? " (overflowed)" : "", *row.speedUp());
		fmt::print(stderr, "{}\n", text);
	}

	Settings settings_;
	fs::path scenes_;
	TessellationTable table_;
	PeerTable peer_;
	std::unique_ptr<Device> device_;
	std::unique_ptr<ClockLoad> clock_load_;
	std::optional<LoadedScene> loaded_;
	Measurements results_;
	uint32_t messages_ = 0;  // of devices that are gone
};

}  // namespace

Result<std::unique_ptr<Bench>> Bench::create(const Settings& settings)
{
	auto bench = std::make_unique<DeviceBench>(settings);
	TRY(bench->initialize());
	return bench;
}

}  // namespace tessera::bench
