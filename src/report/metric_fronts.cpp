#include "report/metric_fronts.h"

#include <algorithm>
#include <cmath>

namespace tessera::report
{

namespace
{

constexpr int kLevels = 33;  // errors that are compared at, evenly spaced by their logarithm

struct FrontPoint
{
	double error_px, cost;
};

double costOf(const Run& run, Cost cost)
{
	return cost == Cost::Time ? run.gpu_ms.median : double(run.counts.micro_triangles);
}

// By falling error and rising cost: what no run beats in both.
std::vector<FrontPoint> frontOf(std::span<const Run* const> runs, ErrorKind kind, Cost cost)
{
	std::vector<FrontPoint> all, front;
	for (const Run* run : runs)
		if (const auto error = errorOf(*run, kind); error && *error > 0 && costOf(*run, cost) > 0)
			all.push_back({ *error, costOf(*run, cost) });
	std::sort(all.begin(), all.end(),
			  [](const FrontPoint& a, const FrontPoint& b) { return std::pair(a.cost, a.error_px) < std::pair(b.cost, b.error_px); });
	for (const FrontPoint& point : all)
		if (front.empty() || point.error_px < front.back().error_px)
			front.push_back(point);
	return front;
}

std::optional<double> costOnFront(const std::vector<FrontPoint>& front, double error_px)
{
	for (size_t i = 0; i + 1 < front.size(); ++i)
	{
		const FrontPoint &coarse = front[i], &fine = front[i + 1];
		if (error_px > coarse.error_px || error_px < fine.error_px)
			continue;
		const double share = std::log(coarse.error_px / error_px) / std::log(coarse.error_px / fine.error_px);
		return coarse.cost * std::pow(fine.cost / coarse.cost, share);
	}
	return std::nullopt;
}

// By raster path or metric, in the order in which they first occur.
std::vector<std::vector<const Run*>> groupsBy(std::string Setting::*name, std::span<const Run* const> runs)
{
	std::vector<std::vector<const Run*>> groups;
	for (const Run* run : runs)
	{
		const auto same =
			std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group[0]->setting.*name == run->setting.*name; });
		if (same == groups.end())
			groups.push_back({ run });
		else
			same->push_back(run);
	}
	return groups;
}

std::optional<MetricComparison> compare(std::span<const Run* const> runs, std::span<const Run* const> baseline, ErrorKind kind, Cost cost)
{
	const std::vector<FrontPoint> front = frontOf(runs, kind, cost), other = frontOf(baseline, kind, cost);
	if (front.size() < 2 || other.size() < 2)
		return std::nullopt;
	const double least = std::max({ front.back().error_px, other.back().error_px, kFloorPx });
	const double most = std::min(front.front().error_px, other.front().error_px);
	if (least >= most)
		return std::nullopt;
	const Setting& setting = runs[0]->setting;
	MetricComparison result = { setting.metric, baseline[0]->setting.metric, setting.raster, setting.width, setting.height, cost, 1, 0, least, most };
	double logarithms = 0;
	int count = 0;
	for (int level = 0; level < kLevels; ++level)
	{
		const double error = std::clamp(least * std::pow(most / least, double(level) / (kLevels - 1)), least, most);
		const auto here = costOnFront(front, error), there = costOnFront(other, error);
		if (!here || !there)
			continue;
		logarithms += std::log(*here / *there);
		result.worst_ratio = std::max(result.worst_ratio, *here / *there);
		++count;
	}
	if (count == 0)
		return std::nullopt;
	result.ratio = std::exp(logarithms / count);
	return result;
}

}  // namespace

std::optional<double> costAt(std::span<const Run* const> runs, ErrorKind kind, Cost cost, double error_px)
{
	return costOnFront(frontOf(runs, kind, cost), error_px);
}

std::vector<MetricComparison> compareMetrics(std::span<const Run> runs, ErrorKind kind, Cost cost)
{
	std::vector<MetricComparison> comparisons;
	for (const auto& of_size : bySize(runs))
		for (const auto& of_raster : groupsBy(&Setting::raster, of_size))
		{
			const auto metrics = groupsBy(&Setting::metric, of_raster);
			for (size_t i = 1; i < metrics.size(); ++i)
				if (const auto comparison = compare(metrics[i], metrics[0], kind, cost))
					comparisons.push_back(*comparison);
		}
	return comparisons;
}

std::string describe(const MetricComparison& comparison, ErrorKind kind)
{
	return fmt::format("{}x{}, {}: {} takes {:.3f} times the {} of {} at equal error ({}, {} to {} px; at worst {:.3f} times).", comparison.width,
					   comparison.height, comparison.raster, comparison.metric, comparison.ratio,
					   comparison.cost == Cost::Time ? "GPU time" : "micro-triangles", comparison.baseline, nameOf(kind),
					   threeDigits(comparison.least_px), threeDigits(comparison.most_px), comparison.worst_ratio);
}

}  // namespace tessera::report
