#include "report/recommend.h"

#include <algorithm>

namespace tessera::report
{

namespace
{

constexpr ErrorKind kJudge = ErrorKind::SeenP99;  // what is exact
constexpr ErrorKind kBound = ErrorKind::SeenMax;  // what stays under a limit

std::string describe(const Run& run)
{
	return fmt::format("rate {} by {} with {}: at most {} px of what is seen (99th percentile {}), {} ms, {} micro-triangles", run.setting.rate,
					   run.setting.metric, run.setting.raster, threeDigits(*errorOf(run, kBound)), threeDigits(*errorOf(run, kJudge)),
					   threeDigits(run.gpu_ms.median), run.counts.micro_triangles);
}

std::vector<const Run*> measuredOf(std::span<const Run* const> runs)
{
	std::vector<const Run*> measured;
	std::copy_if(runs.begin(), runs.end(), std::back_inserter(measured), [](const Run* run) { return errorOf(*run, kJudge).has_value(); });
	return measured;
}

const Run* cheapestUnder(std::span<const Run* const> runs, double error_px)
{
	const Run* best = nullptr;
	for (const Run* run : runs)
		if (*errorOf(*run, kBound) <= error_px && (!best || run->gpu_ms.median < best->gpu_ms.median))
			best = run;
	return best;
}

const Run* bestUnder(std::span<const Run* const> runs, double ms)
{
	const Run* best = nullptr;
	for (const Run* run : runs)
		if (run->gpu_ms.median <= ms && (!best || *errorOf(*run, kJudge) < *errorOf(*best, kJudge)))
			best = run;
	return best;
}

Advice adviceOn(const std::string& size, const std::string& wish, const Run* run, const std::string& otherwise)
{
	if (run)
		return { fmt::format("{}: {} is {}.", size, wish, describe(*run)), run };
	return { fmt::format("{}: {} — none of those tried; {}.", size, wish, otherwise), nullptr };
}

}  // namespace

std::string_view nameOf(ErrorKind kind)
{
	constexpr std::string_view kNames[] = { "99th percentile, seen", "largest, seen", "root mean square, seen", "99th percentile, whole surface",
											"largest, whole surface" };
	return kNames[static_cast<uint8_t>(kind)];
}

std::string_view keyOf(ErrorKind kind)
{
	constexpr std::string_view kKeys[] = { "seen_p99", "seen_max", "seen_rms", "whole_p99", "whole_max" };
	return kKeys[static_cast<uint8_t>(kind)];
}

std::optional<double> errorOf(const Run& run, ErrorKind kind)
{
	const bool seen = kind == ErrorKind::SeenP99 || kind == ErrorKind::SeenMax || kind == ErrorKind::SeenRms;
	if (!run.failure.empty() || !run.surface || (seen && run.surface->visible.samples == 0))
		return std::nullopt;
	const Figures& px = seen ? run.surface->visible.px : run.surface->whole.px;
	switch (kind)
	{
	case ErrorKind::SeenP99:
	case ErrorKind::WholeP99:
		return px.p99;
	case ErrorKind::SeenRms:
		return px.rms;
	case ErrorKind::SeenMax:
	case ErrorKind::WholeMax:
		return px.max;
	}
	return std::nullopt;
}

std::vector<size_t> paretoFront(std::span<const Run* const> runs, ErrorKind kind)
{
	std::vector<size_t> order;
	for (size_t i = 0; i < runs.size(); ++i)
		if (errorOf(*runs[i], kind))
			order.push_back(i);
	std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
		return std::pair(runs[a]->gpu_ms.median, *errorOf(*runs[a], kind)) < std::pair(runs[b]->gpu_ms.median, *errorOf(*runs[b], kind));
	});
	std::vector<size_t> front;
	for (const size_t i : order)
		if (front.empty() || *errorOf(*runs[i], kind) < *errorOf(*runs[front.back()], kind))
			front.push_back(i);
	return front;
}

std::vector<Advice> recommend(std::span<const Run> runs, const Limits& limits)
{
	std::vector<Advice> advice;
	for (const auto& all : bySize(runs))
	{
		const std::vector<const Run*> measured = measuredOf(all);
		if (measured.empty())
			continue;
		const std::string size = fmt::format("{}x{}", measured[0]->setting.width, measured[0]->setting.height);
		if (limits.max_error_px)
			advice.push_back(adviceOn(size, fmt::format("the cheapest with an error of at most {} px", *limits.max_error_px),
									  cheapestUnder(measured, *limits.max_error_px), "a finer rate has to be added to --rates"));
		if (limits.max_ms)
			advice.push_back(adviceOn(size, fmt::format("the most exact within {} ms", *limits.max_ms), bestUnder(measured, *limits.max_ms),
									  "a coarser rate has to be added to --rates, or a smaller picture drawn"));
	}
	return advice;
}

std::vector<std::vector<const Run*>> bySize(std::span<const Run> runs)
{
	std::vector<std::vector<const Run*>> sizes;
	for (const Run& run : runs)
	{
		const auto same = std::find_if(sizes.begin(), sizes.end(), [&](const auto& group) {
			return group[0]->setting.width == run.setting.width && group[0]->setting.height == run.setting.height;
		});
		if (same == sizes.end())
			sizes.push_back({ &run });
		else
			same->push_back(&run);
	}
	return sizes;
}

}  // namespace tessera::report
