#include "app/left_out.h"

#include "app/list_options.h"
#include "app/scene_load.h"
#include "base/log.h"
#include "frame/frame_resources.h"
#include "frame/renderer.h"
#include "pipeline/passes.h"
#include "plan/forced.h"
#include "report/progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tessera
{

using report::LeftOut;
using report::Run;

namespace
{

constexpr uint32_t kFrames = 48;                  // of every group, when not asked for
constexpr uint32_t kFramesPerRound = 6;           // a frame before those of a round is not counted
constexpr uint32_t kLeastFrames = 2;              // of a round, where frames are slow
constexpr double kSeconds = 40;                   // for all rounds; at least one is drawn
constexpr std::string_view kNothing = "nothing";  // the run to compare with

// What is left out under one condition, and the frames drawn with it.
struct Group
{
	std::string name;  // of the first thing in it; what --force is given
	Forced forced;
	std::vector<size_t> members;  // of ReportData::left_out
	std::vector<double> gpu_ms;
	std::string failure;
};

bool isSame(const Forced& a, const Forced& b)
{
	return a.conditions == b.conditions && a.outputs == b.outputs;
}

std::vector<LeftOut> listLeftOut(const FramePlan& plan)
{
	std::vector<LeftOut> list;
	const auto add = [&](std::string_view kind, std::string_view name, std::string_view reason, uint64_t bytes) {
		LeftOut& item = list.emplace_back();
		item.kind = kind;
		item.name = name;
		item.reason = reason;
		item.bytes = bytes;
	};
	for (const DroppedPass& pass : plan.dropped)
		add("pass", pass.name, pass.reason, 0);
	for (const Feature& feature : plan.features)
		if (!feature.on)
			add("shader feature", feature.name, feature.reason, 0);
	for (const PlannedResource& resource : plan.resources)
		if (!resource.kept)
			add(resource.kind, resource.name, resource.reason, resource.bytes);
	return list;
}

// What an error says behind the option and the name.
std::string whyNot(const std::string& message)
{
	constexpr std::string_view kBefore = "cannot be forced: ";
	const size_t place = message.find(kBefore);
	return place == std::string::npos ? message : message.substr(place + kBefore.size());
}

// Two standard errors of the difference of the medians: of normal values a median's is 1.25 deviations / sqrt(n), a deviation 0.74 interquartile
// ranges.
double noiseOf(const Run& a, const Run& b)
{
	const auto error = [](const Run& run) {
		return 1.25 * 0.74 * (run.gpu_ms.upper_quartile - run.gpu_ms.lower_quartile) / std::sqrt(std::max(double(run.frames), 1.0));
	};
	return 2 * std::hypot(error(a), error(b));
}

class LeftOutTimes
{
public:
	LeftOutTimes(const SweepSubject& subject, const AppOptions& options, const Camera& camera, report::RunLog& log, std::vector<LeftOut>& items)
		: subject_(subject), options_(options), camera_(camera), log_(log), items_(items)
	{}

	Status measure(const PlanInput& input)
	{
		makeGroups(input);
		std::vector<Run> runs;
		const bool all_there =
			std::all_of(groups_.begin(), groups_.end(), [&](const Group& group) { return log_.find(settingOf(group)) != nullptr; });
		if (!all_there)
			TRY(drawRounds());
		for (const Group& group : groups_)
		{
			runs.push_back(all_there ? *log_.find(settingOf(group)) : runOf(group));
			if (!all_there && !log_.find(settingOf(group)))
				TRY(log_.add(runs.back()));
		}
		for (size_t i = 1; i < groups_.size(); ++i)
			for (const size_t member : groups_[i].members)
				fillIn(items_[member], groups_[i], runs[i], runs[0]);
		return {};
	}

private:
	// The first is that in which nothing is forced.
	void makeGroups(const PlanInput& input)
	{
		groups_.push_back({ std::string(kNothing), {}, {}, {}, {} });
		for (size_t i = 0; i < items_.size(); ++i)
		{
			std::vector<std::string> names = subject_.options.forced;
			names.push_back(items_[i].name);
			auto forced = forcedBy(names, framePasses(), resourceDescs(), kWantedOutputs, input);
			if (!forced)
			{
				items_[i].not_measured = whyNot(forced.error().message);
				continue;
			}
			auto same = std::find_if(groups_.begin() + 1, groups_.end(), [&](const Group& group) { return isSame(group.forced, *forced); });
			if (same == groups_.end())
				same = groups_.insert(groups_.end(), { items_[i].name, std::move(*forced), {}, {}, {} });
			same->members.push_back(i);
		}
	}

	AppOptions optionsOf(const Group& group) const
	{
		AppOptions options = options_;
		if (&group != &groups_[0])
			options.forced.push_back(group.name);
		return options;
	}

	report::Setting settingOf(const Group& group) const
	{
		std::vector<std::string> names = options_.forced;
		names.push_back(group.name);
		return { double(options_.rate), std::string(rasterName(options_.raster)), std::string(metricName(options_.metric)), options_.width_px,
				 options_.height_px,    fmt::format("{}", fmt::join(names, "+")) };
	}

	Status drawRounds()
	{
		using Clock = std::chrono::steady_clock;
		TRY_ASSIGN(const std::unique_ptr<Renderer> renderer,
				   Renderer::create(subject_.device, subject_.scene, subject_.table, framePasses(), options_));
		report::Progress progress(!options_.quiet);
		const uint32_t frames = options_.frames > 1 ? options_.frames : kFrames, rounds = (frames + kFramesPerRound - 1) / kFramesPerRound;
		progress.begin("what the scene does not need", rounds * groups_.size());
		Clock::time_point start;
		double spent_s = 0;
		for (uint32_t round = 0; round <= rounds && spent_s < kSeconds; ++round)
		{
			// In the first, pipelines are made: it is not counted, neither as frames nor as time.
			const bool counts = round > 0;
			if (round == 1)
				start = Clock::now();
			for (Group& group : groups_)
			{
				TRY(drawRound(*renderer, group, counts));
				if (counts)
					progress.advance();
			}
			if (counts)
				spent_s = std::chrono::duration<double>(Clock::now() - start).count();
		}
		progress.end();
		return {};
	}

	// What one group cannot do is said of it; what nothing forced cannot do is an error.
	Status drawRound(Renderer& renderer, Group& group, bool counts)
	{
		if (!group.failure.empty())
			return {};
		const auto draw = [&]() -> Status {
			TRY(renderer.setOptions(optionsOf(group)));
			TRY(renderer.renderFrame(camera_));
			double ms = 0;
			for (uint32_t frame = 0; counts && frame < kFramesPerRound && (frame < kLeastFrames || ms < 200); ++frame)
			{
				TRY_ASSIGN(const FrameResult result, renderer.renderFrame(camera_));
				group.gpu_ms.push_back(result.gpu_ms);
				ms += result.gpu_ms;
			}
			return {};
		};
		const Status status = draw();
		if (!status && (&group == &groups_[0] || status.error().code == ExitCode::DeviceLost))
			return status;
		if (!status)
			group.failure = status.error().message;
		return {};
	}

	Run runOf(const Group& group) const
	{
		Run run;
		run.setting = settingOf(group);
		run.failure = group.failure;
		run.rate_granted = double(options_.rate);
		run.frames = static_cast<uint32_t>(group.gpu_ms.size());
		run.gpu_ms = report::timeFigures(group.gpu_ms);
		return run;
	}

	static void fillIn(LeftOut& item, const Group& group, const Run& forced, const Run& plain)
	{
		item.measured_with = group.name;
		item.not_measured = forced.failure;
		if (!forced.failure.empty())
			return;
		item.saved_ms = forced.gpu_ms.median - plain.gpu_ms.median;
		item.noise_ms = noiseOf(forced, plain);
	}

	const SweepSubject& subject_;
	const AppOptions& options_;
	const Camera& camera_;
	report::RunLog& log_;
	std::vector<LeftOut>& items_;
	std::vector<Group> groups_;
};

}  // namespace

Status addLeftOut(const SweepSubject& subject, report::RunLog& log, report::ReportData& data)
{
	AppOptions first = optionsFor(subject.options, sizesOf(subject.options)[0]);
	first.rate = static_cast<float>(ratesOf(subject.options)[0]);
	for (const Raster raster : rastersOf(subject.options))
		if (data.closed.count(std::string(rasterName(raster))) == 0)
		{
			first.raster = raster;
			break;
		}
	first.metric = metricsOf(subject.options)[0];
	TRY_ASSIGN(const std::vector<Camera> cameras, chooseCameras(subject.scene, first));
	TRY_ASSIGN(const ScenePlan planned, planScene(subject.scene, cameras[0], first, traitsOf(subject.device), subject.table));
	data.left_out = listLeftOut(planned.plan);
	data.bytes_kept = planned.bytesKept();
	data.bytes_saved = planned.bytesSaved();
	if (subject.options.measure_left_out)
		return LeftOutTimes(subject, first, cameras[0], log, data.left_out).measure(planned.input);
	for (LeftOut& item : data.left_out)
		item.not_measured = "--measure-left-out is off";
	return {};
}

}  // namespace tessera
