#include "app/report_drawing.h"

#include "frame/timed_frames.h"

#include <algorithm>

namespace tessera
{

using report::Run;

namespace
{

constexpr uint32_t kFrames = 24, kWarmup = 8;  // when not asked for
constexpr double kRunSeconds = 30;             // of drawing, for one run; at least kLeastFrames are drawn all the same
constexpr uint32_t kLeastFrames = 3;

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

class PathDrawing
{
public:
	PathDrawing(Renderer& renderer, ClockLoad& load, std::span<const Camera> cameras, const AppOptions& options, report::Progress& progress, Run& run)
		: renderer_(renderer), load_(load), cameras_(cameras), progress_(progress), run_(run)
	{
		const bool asked = options.frames > 1 || options.warmup > 0;
		frames_ = shareOf(asked ? options.frames : kFrames);
		warmup_ = shareOf(asked ? options.warmup : kWarmup);
	}

	Result<std::vector<DrawnView>> draw()
	{
		std::vector<DrawnView> views(cameras_.size());
		run_.cameras = static_cast<uint32_t>(cameras_.size());
		report::RunCounts sum;
		for (size_t i = cameras_.size(); i-- > 0;)
		{
			TRY_ASSIGN(const FrameResult last, drawFrames(cameras_[i]));
			views[i] = { renderer_.view(), last.rate_granted };
			addCounts(sum, countsOf(last.counts));
			run_.rate_granted = std::max(run_.rate_granted, last.rate_granted);
			run_.every_factor_one = run_.every_factor_one || last.every_factor_one;
			run_.rounds = std::max(run_.rounds, last.rounds);
		}
		run_.counts = meanCounts(sum, cameras_.size());
		run_.gpu_ms = report::timeFigures(std::move(frame_ms_));
		for (auto& [name, ms] : pass_ms_)
			run_.passes.push_back({ name, report::timeFigures(std::move(ms)) });
		return views;
	}

private:
	uint32_t shareOf(uint32_t frames) const
	{
		const auto cameras = static_cast<uint32_t>(cameras_.size());
		return (frames + cameras - 1) / cameras;
	}

	// Warms up, then draws until there are enough frames or the camera's share of the run's time is over; gives the last.
	Result<FrameResult> drawFrames(const Camera& camera)
	{
		TimedFrames timed(renderer_, load_);
		const auto share = [&] {
			return timed.seconds() * double(cameras_.size()) / kRunSeconds;
		};
		progress_.begin(fmt::format("drawing {}", run_.setting.label()), warmup_ + frames_);
		const auto isWarm = [&](uint32_t frames) {
			return (frames >= warmup_ && timed.isSettled()) || (frames > 0 && share() >= 0.25);
		};
		for (uint32_t i = 0; !isWarm(i); ++i, ++run_.warmup)
		{
			TRY(timed.draw(camera));
			if (i < warmup_)
				progress_.advance();
		}
		FrameResult last;
		for (uint32_t i = 0; i < frames_ && (i < std::min(frames_, kLeastFrames) || share() < 1); ++i, ++run_.frames, progress_.advance())
		{
			TRY_ASSIGN(last, timed.draw(camera));
			frame_ms_.push_back(last.gpu_ms);
			addPasses(last.passes);
		}
		progress_.end();
		return last;
	}

	void addPasses(const std::vector<PassTime>& passes)
	{
		for (const PassTime& pass : passes)
		{
			auto found = std::find_if(pass_ms_.begin(), pass_ms_.end(), [&](const auto& entry) { return entry.first == pass.name; });
			if (found == pass_ms_.end())
				found = pass_ms_.insert(pass_ms_.end(), { pass.name, {} });
			found->second.push_back(pass.gpu_ms);
		}
	}

	Renderer& renderer_;
	ClockLoad& load_;
	std::span<const Camera> cameras_;
	report::Progress& progress_;
	Run& run_;
	uint32_t frames_ = 0, warmup_ = 0;  // of each camera
	std::vector<double> frame_ms_;
	PassTimes pass_ms_;
};

}  // namespace

Result<std::vector<DrawnView>> drawPath(Renderer& renderer, ClockLoad& load, std::span<const Camera> cameras, const AppOptions& options,
										report::Progress& progress, Run& run)
{
	return PathDrawing(renderer, load, cameras, options, progress, run).draw();
}

report::RunBytes bytesOf(const MemoryStats& memory)
{
	return { memory.lists, memory.geometry + memory.rays, memory.textures, memory.images };
}

}  // namespace tessera
