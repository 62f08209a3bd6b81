#include "report/report_charts.h"

#include "report/page_original.h"

#include <algorithm>
#include <functional>
#include <set>

namespace tessera::report
{

namespace
{

using Value = std::function<double(const Run&)>;

// Runs of one metric, raster path and picture size, by rate from coarse to fine.
struct Group
{
	std::string name;
	std::vector<const Run*> runs;
};

std::vector<Group> groupsOf(const ReportData& data)
{
	const bool many_sizes = bySize(data.runs).size() > 1;
	const bool many_metrics =
		std::any_of(data.runs.begin(), data.runs.end(), [&](const Run& run) { return run.setting.metric != data.runs[0].setting.metric; });
	const bool many_rasters =
		std::any_of(data.runs.begin(), data.runs.end(), [&](const Run& run) { return run.setting.raster != data.runs[0].setting.raster; });
	std::vector<Group> groups;
	for (const Run& run : data.runs)
	{
		if (!run.failure.empty())
			continue;
		const Setting& s = run.setting;
		std::string name = many_metrics ? s.metric : "";
		if (many_rasters || !many_metrics)
			name += (name.empty() ? "" : " ") + s.raster;
		if (many_sizes)
			name += fmt::format(" {}x{}", s.width, s.height);
		auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.name == name; });
		if (found == groups.end())
			found = groups.insert(groups.end(), { name, {} });
		found->runs.push_back(&run);
	}
	for (Group& group : groups)
		std::stable_sort(group.runs.begin(), group.runs.end(), [](const Run* a, const Run* b) { return a->setting.rate > b->setting.rate; });
	return groups;
}

std::string hintOf(const Run& run)
{
	std::string hint = fmt::format("{}\n{:.4g} ms (quartiles {:.4g} to {:.4g})\n{} micro-triangles", run.setting.label(), run.gpu_ms.median,
								   run.gpu_ms.lower_quartile, run.gpu_ms.upper_quartile, run.counts.micro_triangles);
	for (const ErrorKind kind : kErrorKinds)
		if (const auto error = errorOf(run, kind))
			hint += fmt::format("\n{:.3g} px {}", *error, nameOf(kind));
	if (hasOriginal(run))
		hint += fmt::format("\n{:.3g} from the original, world units (root mean square; 99th percentile {:.3g}, largest {:.3g})",
							run.surface->original->drawn.world.rms, run.surface->original->drawn.world.p99, run.surface->original->drawn.world.max);
	if (run.isCoarsened())
		hint += fmt::format("\ncoarsened to rate {:.4g}", run.rate_granted);
	return hint;
}

// Runs without one of the values are left out.
std::vector<ChartSeries> seriesOf(const ReportData& data, const Value& x, const Value& y, const std::function<bool(const Run&)>& has,
								  const std::set<const Run*>& strong)
{
	std::vector<ChartSeries> all;
	size_t color = 0;
	for (const Group& group : groupsOf(data))
	{
		ChartSeries series = { group.name, color++ % kChartColors, {}, true };
		for (const Run* run : group.runs)
			if (has(*run))
				series.points.push_back({ x(*run), y(*run), hintOf(*run), strong.empty() || strong.count(run) > 0 });
		all.push_back(std::move(series));
	}
	return all;
}

std::vector<const Run*> frontOf(const ReportData& data, ErrorKind kind)
{
	std::vector<const Run*> front;
	for (const auto& runs : bySize(data.runs))
		for (const size_t i : paretoFront(runs, kind))
			front.push_back(runs[i]);
	return front;
}

}  // namespace

std::vector<NamedChart> errorCharts(const ReportData& data, ErrorKind kind)
{
	const Value error = [kind](const Run& run) {
		return errorOf(run, kind).value_or(0);
	};
	const Value time = [](const Run& run) {
		return run.gpu_ms.median;
	};
	const auto has = [kind](const Run& run) {
		return errorOf(run, kind).has_value();
	};
	const std::vector<const Run*> front = frontOf(data, kind);
	const std::set<const Run*> strong(front.begin(), front.end());
	const std::string error_label = fmt::format("error, pixels ({})", nameOf(kind));

	LineChart against_time = {
		"Error against GPU time", "GPU time per frame, ms (median)", error_label, seriesOf(data, time, error, has, strong), {}, ""
	};
	if (bySize(data.runs).size() == 1)
		for (const Run* run : front)
			against_time.front.push_back({ time(*run), error(*run), "", true });
	against_time.front_name = "Pareto front: nothing tried is both faster and more exact";
	const LineChart against_rate = { "Error against rate",
									 "tessellation rate, pixels per segment",
									 error_label,
									 seriesOf(data, [](const Run& run) { return run.setting.rate; }, error, has, {}),
									 {},
									 "" };
	const LineChart against_triangles = { "Error against triangles",
										  "micro-triangles drawn",
										  error_label,
										  seriesOf(data, [](const Run& run) { return double(run.counts.micro_triangles); }, error, has, {}),
										  {},
										  "" };
	const std::string key(keyOf(kind));
	return { { "error_time_" + key, chartSvg(against_time) },
			 { "error_rate_" + key, chartSvg(against_rate) },
			 { "error_triangles_" + key, chartSvg(against_triangles) } };
}

std::vector<NamedChart> originalCharts(const ReportData& data)
{
	const auto measured = std::find_if(data.runs.begin(), data.runs.end(), hasOriginal);
	if (measured == data.runs.end())
		return {};
	const AgainstOriginal& ends = *measured->surface->original;
	const Value time = [](const Run& run) {
		return run.gpu_ms.median;
	};
	const Value triangles = [](const Run& run) {
		return double(run.counts.micro_triangles);
	};
	struct Kind
	{
		double Figures::*figure;
		std::string_view name, key;
	};
	std::vector<NamedChart> charts;
	for (const Kind& kind : { Kind{ &Figures::rms, "root mean square", "rms" }, Kind{ &Figures::p99, "99th percentile", "p99" } })
		for (const bool over_time : { false, true })
		{
			const Value error = [figure = kind.figure](const Run& run) {
				return run.surface->original->drawn.world.*figure;
			};
			const LineChart chart = { over_time ? "Distance to the original against GPU time" : "Distance to the original against triangles",
									  over_time ? "GPU time per frame, ms (median)" : "micro-triangles drawn",
									  fmt::format("world units ({})", kind.name),
									  seriesOf(data, over_time ? time : triangles, error, hasOriginal, {}),
									  {},
									  "",
									  { { ends.floor.world.*kind.figure, "floor: the reference surface", false },
										{ ends.undisplaced.world.*kind.figure, "not displaced", true } } };
			charts.push_back({ fmt::format("original_{}_{}", over_time ? "time" : "triangles", kind.key), chartSvg(chart) });
		}
	return charts;
}

namespace
{

// Passes that take most of the time in some run get a colour of their own, the others share the last.
std::vector<std::string> namedPasses(const ReportData& data)
{
	std::vector<std::pair<double, std::string>> shares;
	for (const Run& run : data.runs)
		for (const PassFigures& pass : run.passes)
		{
			const double share = run.gpu_ms.median > 0 ? pass.gpu_ms.median / run.gpu_ms.median : 0;
			const auto found = std::find_if(shares.begin(), shares.end(), [&](const auto& entry) { return entry.second == pass.name; });
			if (found == shares.end())
				shares.emplace_back(share, pass.name);
			else
				found->first = std::max(found->first, share);
		}
	std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
	std::vector<std::string> names;
	for (size_t i = 0; i < std::min(shares.size(), shares.size() > kChartColors ? kChartColors - 1 : kChartColors); ++i)
		names.push_back(shares[i].second);
	return names;
}

Bar barOf(const Run& run, const std::string& group, const std::vector<std::string>& names)
{
	Bar bar = { fmt::format("{:g} px, {}", run.setting.rate, group), {}, threeDigits(run.gpu_ms.median) + " ms" };
	BarSegment others = { names.size(), 0, "" };
	for (size_t i = 0; i < names.size(); ++i)
		for (const PassFigures& pass : run.passes)
			if (pass.name == names[i])
				bar.segments.push_back({ i, pass.gpu_ms.median,
										 fmt::format("{}\n{}: {:.4g} ms (least {:.4g}, most {:.4g})", run.setting.label(), pass.name,
													 pass.gpu_ms.median, pass.gpu_ms.min, pass.gpu_ms.max) });
	for (const PassFigures& pass : run.passes)
		if (std::find(names.begin(), names.end(), pass.name) == names.end())
		{
			others.value += pass.gpu_ms.median;
			others.hint += fmt::format("{}{}: {:.4g} ms", others.hint.empty() ? run.setting.label() + "\n" : "\n", pass.name, pass.gpu_ms.median);
		}
	if (others.value > 0)
		bar.segments.push_back(others);
	return bar;
}

}  // namespace

std::vector<NamedChart> timeCharts(const ReportData& data)
{
	const auto always = [](const Run&) {
		return true;
	};
	const LineChart against_rate = { "Time against rate",
									 "tessellation rate, pixels per segment",
									 "GPU time per frame, ms (median)",
									 seriesOf(
										 data, [](const Run& run) { return run.setting.rate; }, [](const Run& run) { return run.gpu_ms.median; },
										 always, {}),
									 {},
									 "" };
	BarChart passes = { "Time per pass", "GPU time, ms (median of each pass)", namedPasses(data), {} };
	for (const Group& group : groupsOf(data))
		for (const Run* run : group.runs)
			passes.bars.push_back(barOf(*run, group.name, passes.names));
	const bool has_others = std::any_of(passes.bars.begin(), passes.bars.end(), [&](const Bar& bar) {
		return std::any_of(bar.segments.begin(), bar.segments.end(), [&](const BarSegment& segment) { return segment.color == passes.names.size(); });
	});
	if (has_others)
		passes.names.emplace_back("all others");
	return { { "time_rate", chartSvg(against_rate) }, { "time_passes", chartSvg(passes) } };
}

}  // namespace tessera::report
