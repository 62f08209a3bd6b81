#include "bench/markdown.h"

#include <algorithm>
#include <cmath>

namespace tessera::bench
{

namespace
{

std::string lineOf(const std::vector<std::string>& cells)
{
	std::string text = "|";
	for (const std::string& cell : cells)
		text += " " + cell + " |";
	return text + "\n";
}

// Header and rule; every column but the first `text_columns` is right-aligned.
std::string headOf(const std::vector<std::string>& names, size_t text_columns)
{
	std::string rule = "|";
	for (size_t i = 0; i < names.size(); ++i)
		rule += i < text_columns ? "---|" : "---:|";
	return lineOf(names) + rule + "\n";
}

// Four significant digits or whole microseconds, whichever is less.
std::string msText(double ms)
{
	const int digits = ms >= 100 ? 1 : ms >= 10 ? 2 : 3;
	return fmt::format("{:.{}f}", ms, digits);
}

std::string millions(uint64_t count)
{
	return fmt::format("{:.3f}", double(count) * 1e-6);
}

std::string sizeText(const Row& row)
{
	return fmt::format("{}x{}", row.what.options.width_px, row.what.options.height_px);
}

std::string noteOf(const Row& row, uint32_t frames)
{
	if (row.state == RowState::Failed)
		return "**failed**, see below";
	std::string note;
	const auto add = [&](const std::string& text) {
		note += (note.empty() ? "" : "; ") + text;
	};
	if (row.state == RowState::Coarsened)
		add("**coarsened: does not count**");
	if (row.frames.last.rounds > 1)
		add(fmt::format("{} rounds", row.frames.last.rounds));
	if (row.frames.frame.gpu_ms.size() < frames)
		add(fmt::format("{} frames", row.frames.frame.gpu_ms.size()));
	return note;
}

// What names the row, then times, for every kind of table.
std::vector<std::string> timeCells(const Row& row)
{
	if (row.state == RowState::Failed)
		return { "", "", "" };
	return { msText(row.medianMs()), msText(row.frames.frame.least()), msText(row.frames.frame.most()) };
}

std::vector<std::string> peerCells(const Row& row)
{
	if (!row.peer)
		return { "", "", "" };
	const std::string star = row.peer->overflow ? "*" : "";
	return { fmt::format("{}", row.peer->px), msText(row.peer->gpu_ms) + star, row.speedUp() ? fmt::format("{:.2f}{}", *row.speedUp(), star) : "" };
}

std::string tableLine(const Row& row, uint32_t frames)
{
	const bool failed = row.state == RowState::Failed;
	const FrameCountsRead& counts = row.frames.last.counts;
	const std::vector<std::string> times = timeCells(row), peer = peerCells(row);
	const auto unlessFailed = [&](std::string text) {
		return failed ? std::string() : text;
	};
	return lineOf({ row.what.sceneLabel(), sizeText(row), row.what.raster, row.what.cull ? "on" : "off", fmt::format("{}", row.what.options.rate),
					peer[0], unlessFailed(millions(counts.micro_triangles)), unlessFailed(fmt::format("{}", counts.part_triangles)),
					unlessFailed(fmt::format("{}", counts.split_triangles)), unlessFailed(fmt::format("{:.4g}", row.frames.last.rate_granted)),
					times[0], times[1], times[2], peer[1], peer[2], unlessFailed(fmt::format("{:.1f}", toMib(row.memory.lists))),
					unlessFailed(fmt::format("{:.1f}", toMib(row.memory.total()))), noteOf(row, frames) });
}

std::string headText(std::string_view title, const PageFacts& facts)
{
	std::string text = fmt::format("# {}\n\nDevice: {}. GPU time of whole frames: median, least and most of {} frames after {} of warm-up.\n", title,
								   facts.device, facts.frames, facts.warmup);
	if (!facts.options.empty())
		text += fmt::format("Options of every row: `{}`.\n", facts.options);
	return text;
}

struct Summary
{
	size_t rows = 0, faster = 0;
	double log_sum = 0, least = INFINITY, most = 0;
};

std::string summaryText(std::span<const Row> rows)
{
	std::map<std::pair<std::string, bool>, Summary> summaries;
	for (const Row& row : rows)
		if (const std::optional<double> speed_up = row.speedUp())
		{
			Summary& sum = summaries[{ row.what.raster, row.what.cull }];
			++sum.rows;
			sum.faster += *speed_up > 1;
			sum.log_sum += std::log(*speed_up);
			sum.least = std::min(sum.least, *speed_up);
			sum.most = std::max(sum.most, *speed_up);
		}
	if (summaries.empty())
		return {};
	std::string text = "\n## Against the peer\n\n" + headOf({ "raster", "cull", "rows", "faster", "speed-up, geometric mean", "least", "most" }, 2);
	for (const auto& [key, sum] : summaries)
		text += lineOf({ key.first, key.second ? "on" : "off", fmt::format("{}", sum.rows), fmt::format("{}", sum.faster),
						 fmt::format("{:.2f}", std::exp(sum.log_sum / double(sum.rows))), fmt::format("{:.2f}", sum.least),
						 fmt::format("{:.2f}", sum.most) });
	return text;
}

std::string peerText(const PageFacts& facts)
{
	if (facts.peer_device.empty())
		return {};
	return fmt::format(
		"Peer: vk_tessellated_clusters on {}, its raster path with culling off, at equal work (its px per segment is our rate / 0.866).\n"
		"Speed-up: the peer's time over our median. *: its buffers overflowed and triangles vanished; its time is with raised limits.\n",
		facts.peer_device);
}

std::string failuresText(std::span<const Row> rows, const PageFacts& facts)
{
	std::string text;
	for (const auto& [raster, reason] : facts.closed)
		text += fmt::format("- raster path {} is closed here, its rows are left out: {}\n", raster, reason);
	for (const Row& row : rows)
		if (row.state == RowState::Failed)
			text += fmt::format("- {}: failed: {}\n", row.what.label(), row.error);
	return text.empty() ? text : "\n## Not measured\n\n" + text;
}

std::string comparisonText(const PageFacts& facts)
{
	if (!facts.comparison)
		return {};
	const Comparison& comparison = *facts.comparison;
	std::string text = "\n## Against the stored table\n\n";
	if (!comparison.stored_device.empty())
		text += fmt::format("**That table is of another device: {}.**\n\n", comparison.stored_device);
	text += fmt::format("{} rows are compared, {} are in one table only.\n\n", comparison.rows.size(), comparison.unmatched);
	text += headOf({ "row", "now ms", "stored ms", "ratio", "" }, 1);
	for (const ComparedRow& row : comparison.rows)
		text +=
			lineOf({ row.name, msText(row.now_ms), msText(row.stored_ms), fmt::format("{:.3f}", row.ratio()), row.isSlower() ? "**slower**" : "" });
	return text;
}

// What a driver was measured to take for a million triangles, H100, driver 580.159: a build that prefers building fast.
constexpr double kDriverBuildMs = 1.19;

// Those that the frame's structures were built for: of one structure, or of all clusters.
uint64_t reservedTriangles(const RayStats& rays)
{
	uint64_t triangles = rays.triangles.capacity;
	for (const ListStats& list : rays.clusters.lists)
		triangles += list.name == "ray_instantiated_triangles" || list.name == "ray_transient_triangles" ? list.capacity : 0;
	return triangles;
}

// Building and tracing by themselves.
std::string raysText(std::span<const Row> rows)
{
	std::string text = "\n## Building and tracing\n\nLimit: what the driver alone took for as many triangles of one grid (H100).\n\n";
	text += headOf({ "raster", "rate px", "Mtri", "reserved Mtri", "build ms", "ms per reserved Mtri", "limit ms", "primary ms", "shadows ms",
					 "ambient ms", "rays per pixel", "structures MiB" },
				   1);
	for (const Row& row : rows)
	{
		if (row.what.series != "rays" || row.state == RowState::Failed)
			continue;
		const auto took = [&](const char* pass) {
			const auto found = row.frames.passes.find(pass);
			return found == row.frames.passes.end() ? 0 : found->second.median();
		};
		const RayStats& rays = row.frames.last.rays;
		const double millions_built = double(reservedTriangles(rays)) * 1e-6;
		double build_ms = 0;
		for (const char* pass : { "build_geometry", "clear_clusters", "list_clusters", "list_structures", "insert_clusters", "instantiate_clusters",
								  "build_transients", "build_structures" })
			build_ms += took(pass);
		text += lineOf({ row.what.raster, fmt::format("{}", row.what.options.rate), millions(row.frames.last.counts.micro_triangles),
						 millions(reservedTriangles(rays)), msText(build_ms), msText(millions_built > 0 ? build_ms / millions_built : 0),
						 msText(kDriverBuildMs * millions_built), msText(took("trace_visibility") + took("trace_clusters")),
						 msText(took("trace_shadows")), msText(took("trace_ambient")), fmt::format("{}", row.what.options.ao_samples + 1),
						 fmt::format("{:.1f}", toMib(rays.total())) });
	}
	return text;
}

std::string sweepText(std::span<const Row> rows, std::string_view series, uint32_t frames)
{
	const std::string unit(unitOf(series));
	std::string text = fmt::format("\n## Time against {}s\n\n", unit);
	text += headOf({ "scene", "size", "raster", "cull", "rate px", unit + "s", "Mtri", "gpu ms", "min", "max", "ns per " + unit,
					 "ns per added " + unit, "lists MiB", "total MiB", "note" },
				   4);
	if (series == "rays")
		text = raysText(rows) + text;
	for (const Row& row : rows)
	{
		if (row.what.series != series)
			continue;
		const bool failed = row.state == RowState::Failed;
		const std::vector<std::string> times = timeCells(row);
		std::vector<std::string> cells = { row.what.sceneLabel(), sizeText(row), row.what.raster, row.what.cull ? "on" : "off",
										   fmt::format("{}", row.what.options.rate) };
		cells.push_back(failed ? "" : fmt::format("{:.0f}", unitCount(row)));
		cells.push_back(failed ? "" : millions(row.frames.last.counts.micro_triangles));
		cells.insert(cells.end(), times.begin(), times.end());
		cells.push_back(row.ns_per_unit > 0 ? fmt::format("{:.4g}", row.ns_per_unit) : "");
		cells.push_back(row.ns_per_added_unit != 0 ? fmt::format("{:.4g}", row.ns_per_added_unit) : "");
		cells.push_back(failed ? "" : fmt::format("{:.1f}", toMib(row.memory.lists)));
		cells.push_back(failed ? "" : fmt::format("{:.1f}", toMib(row.memory.total())));
		cells.push_back(noteOf(row, frames));
		text += lineOf(cells);
	}
	return text;
}

}  // namespace

std::string tablePage(std::span<const Row> rows, const PageFacts& facts)
{
	std::string text = headText("GPU time per frame", facts) + peerText(facts) + summaryText(rows) + "\n## All rows\n\n";
	text += headOf({ "scene", "size", "raster", "cull", "rate px", "peer px", "Mtri", "parts", "splits", "granted", "gpu ms", "min", "max", "peer ms",
					 "speed-up", "lists MiB", "total MiB", "note" },
				   4);
	for (const Row& row : rows)
		text += tableLine(row, facts.frames);
	return text + failuresText(rows, facts) + comparisonText(facts);
}

std::string scalingPage(std::span<const Row> rows, const PageFacts& facts)
{
	std::string text = headText("How GPU time grows", facts);
	text += "Per added unit: against the row before of the same raster path and culling, so without what every frame costs.\n";
	for (std::string_view series : scalingNames())
		if (std::any_of(rows.begin(), rows.end(), [&](const Row& row) { return row.what.series == series; }))
			text += sweepText(rows, series, facts.frames);
	return text + failuresText(rows, facts) + comparisonText(facts);
}

}  // namespace tessera::bench
