#include "report/heat.h"
#include "report/metric_fronts.h"
#include "report/page_assets.h"
#include "report/page_original.h"
#include "report/page_pictures.h"
#include "report/report_charts.h"
#include "report/report_table.h"

#include <algorithm>
#include <set>

namespace tessera::report
{

namespace
{

std::string bytesText(uint64_t bytes)
{
	if (bytes < 10'000)
		return fmt::format("{} B", bytes);
	return bytes < 10'000'000 ? fmt::format("{:.0f} KiB", double(bytes) / 1024) : fmt::format("{:.1f} MiB", double(bytes) / (1 << 20));
}

std::set<const Run*> frontRuns(const ReportData& data)
{
	std::set<const Run*> front;
	for (const auto& runs : bySize(data.runs))
		for (const size_t i : paretoFront(runs, ErrorKind::SeenP99))
			front.insert(runs[i]);
	return front;
}

std::string adviceHtml(const ReportData& data)
{
	std::string html = "<div class=\"advice\">";
	for (const Advice& advice : recommend(data.runs, data.limits))
		html += fmt::format("<p>{}</p>", escaped(advice.text));
	if (!data.limits.max_error_px && !data.limits.max_ms)
		html +=
			"<p>Give <code>--max-error-px</code> or <code>--max-ms</code> (with <code>--resume</code>: nothing is measured again) to have a setting "
			"recommended.</p>";
	for (const auto& runs : bySize(data.runs))
	{
		std::string names;
		for (const size_t i : paretoFront(runs, ErrorKind::SeenP99))
			names += fmt::format("{}rate {} by {} with {} ({} px, {} ms)", names.empty() ? "" : "; ", runs[i]->setting.rate,
								 escaped(runs[i]->setting.metric), escaped(runs[i]->setting.raster),
								 threeDigits(*errorOf(*runs[i], ErrorKind::SeenP99)), threeDigits(runs[i]->gpu_ms.median));
		if (!names.empty())
			html += fmt::format("<p class=\"quiet\">Worth having at {}x{} (nothing tried is both faster and more exact): {}.</p>",
								runs[0]->setting.width, runs[0]->setting.height, names);
	}
	for (const Cost cost : { Cost::Time, Cost::Triangles })
		for (const MetricComparison& comparison : compareMetrics(data.runs, ErrorKind::SeenP99, cost))
			html += fmt::format("<p class=\"quiet\">{}</p>", escaped(describe(comparison, ErrorKind::SeenP99)));
	return html + "</div>";
}

std::string plotsHtml(const ReportData& data)
{
	std::string html = "<h2>Error and time</h2><div class=\"choice\"><label>Error: <select id=\"kind\">";
	for (const ErrorKind kind : kErrorKinds)
		html += fmt::format("<option value=\"{}\">{}</option>", keyOf(kind), nameOf(kind));
	html += "</select></label><span class=\"quiet\">in pixels at the camera; hover over a mark for its values</span></div>";
	const std::vector<NamedChart> times = timeCharts(data);  // against the rate, per pass
	for (const ErrorKind kind : kErrorKinds)
	{
		html += fmt::format("<div class=\"grid2\" data-kind=\"{}\"{}>", keyOf(kind), kind == kErrorKinds[0] ? "" : " hidden");
		for (const NamedChart& chart : errorCharts(data, kind))
			html += "<div>" + chart.svg + "</div>";
		html += "<div>" + times[0].svg + "</div></div>";
	}
	return html + "<div class=\"grid2 passes\"><div>" + times[1].svg + "</div></div>";
}

std::string tableHtml(const ReportData& data)
{
	const std::set<const Run*> front = frontRuns(data);
	std::string html =
		"<h2>All runs</h2><p class=\"quiet\">Shaded rows: the Pareto front by the 99th percentile of what is seen. Hover over a heading "
		"for what it means; <code>report.csv</code> has more columns.</p><div class=\"scroll\"><table><thead><tr>";
	const std::vector<const Column*> columns = pageColumns(data);
	for (const Column* column : columns)
		html += fmt::format("<th title=\"{}\">{}</th>", escaped(column->hint), escaped(column->head));
	html += "</tr></thead><tbody>";
	for (const Run& run : data.runs)
	{
		html += front.count(&run) ? "<tr class=\"front\">" : "<tr>";
		for (const Column* column : columns)
			html += fmt::format("<td>{}</td>", escaped((column->shown ? column->shown : column->cell)(run)));
		html += "</tr>";
		if (!run.failure.empty())
			html +=
				fmt::format("<tr><td class=\"text wide\" colspan=\"99\">{} failed: {}</td></tr>", escaped(run.setting.label()), escaped(run.failure));
	}
	html += "</tbody></table></div>";
	for (const auto& [raster, reason] : data.closed)
		html += fmt::format("<p class=\"quiet\">Raster path {} is closed on this device: {}.</p>", escaped(raster), escaped(reason));
	return html;
}

std::string numericsHtml(const ReportData& data)
{
	std::string html =
		"<h2>Numbers</h2><p class=\"quiet\">Of the whole surface, nothing culled: positions that are not finite; the largest error of a position in "
		"units in "
		"the last place of its largest coordinate, against the same evaluation in double precision; that error over the bound derived for it; edges "
		"whose two sides differ in any bit; micro-triangles without area.</p><div class=\"scroll\"><table><thead><tr><th>picture</th><th>rate</th>"
		"<th>metric</th><th>vertices</th><th>not finite</th><th>base, ulp</th><th>displaced, ulp</th><th>of bound</th><th>shared "
		"edges</th><th>points on "
		"them</th><th>edges that differ</th><th>no area</th></tr></thead><tbody>";
	std::set<std::string> there;
	for (const Run& run : data.runs)
	{
		const std::string key =
			fmt::format("{}x{}</td><td>{:g}</td><td>{}", run.setting.width, run.setting.height, run.rate_granted, escaped(run.setting.metric));
		if (!run.surface || !there.insert(key).second)
			continue;
		const Numerics& n = run.surface->numerics;
		html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.3g}</td><td>{:.2f}</td><td>{}</td><td>{}</td><td>{}</td>"
							"<td>{}</td></tr>",
							key, n.vertices, n.not_finite, n.worst_base_ulp, n.worst_displaced_ulp, n.worst_share_of_bound, n.shared_edges,
							n.edge_points, n.differing_edges, n.zero_area_triangles);
		if (!n.first_problem.empty())
			html += fmt::format("<tr><td class=\"text wide\" colspan=\"12\">{}</td></tr>", escaped(n.first_problem));
	}
	return html + "</tbody></table></div>";
}

std::string savedText(const LeftOut& item)
{
	if (!item.saved_ms)
		return "not measured";
	const std::string text = fmt::format("{:.4f} ± {:.4f}", *item.saved_ms, item.noise_ms);
	return item.measured_with == item.name ? text : fmt::format("{} (with {})", text, escaped(item.measured_with));
}

std::string leftOutHtml(const ReportData& data)
{
	std::string html = fmt::format(
		"<h2>What the scene does not need</h2><p class=\"quiet\">At the first rate, metric and picture size. Held: {}; not allocated: {}. "
		"Milliseconds: median GPU time of a frame with it forced on (<code>--force NAME</code>) less that without it, the two drawn in turn; after ± "
		"two standard errors. What is kept under one condition is forced together.</p><div class=\"scroll\"><table><thead><tr><th "
		"class=\"text\">what</th><th class=\"text\">name</th><th>bytes saved</th><th>ms saved</th><th class=\"text\">why it is left out; why "
		"no time</th></tr></thead><tbody>",
		bytesText(data.bytes_kept), bytesText(data.bytes_saved));
	for (const LeftOut& item : data.left_out)
	{
		const std::string no_time =
			item.not_measured.empty() ? "" : fmt::format("<br><span class=\"quiet\">No time: {}</span>", escaped(item.not_measured));
		html += fmt::format("<tr><td class=\"text\">{}</td><td class=\"text\">{}</td><td>{}</td><td>{}</td><td class=\"text wide\">{}{}</td></tr>",
							escaped(item.kind), escaped(item.name), item.bytes > 0 ? bytesText(item.bytes) : "", savedText(item),
							escaped(item.reason), no_time);
	}
	return html + "</tbody></table></div>";
}

std::string samplingText(const ReportData& data)
{
	uint64_t least = 0, most = 0;
	double change = 0;
	std::string unsteady;
	for (const Run& run : data.runs)
		if (run.surface)
			for (const RegionError* region : { &run.surface->visible, &run.surface->whole })
			{
				if (region->samples == 0)
					continue;
				least = least == 0 ? region->samples : std::min(least, region->samples);
				most = std::max(most, region->samples);
				if (region->converged)
					change = std::max(change, region->change);
				else
					unsteady += fmt::format("{}{} ({}: {:.1f} %)", unsteady.empty() ? "" : "; ", escaped(run.setting.label()),
											region == &run.surface->visible ? "seen" : "whole", region->change * 100);
			}
	std::string text = fmt::format(
		"Samples were doubled until no figure (largest, root mean square, 99th percentile; relative to the diagonal and in pixels) changed by more "
		"than 1 %: {} to {} samples; the largest change that was left is {:.2f} %.",
		least, most, change * 100);
	if (!unsteady.empty())
		text += fmt::format(" Not reached with the most samples that are taken: {}.", unsteady);
	return text;
}

uint64_t startTriangles(const ReportData& data)
{
	uint64_t most = 0;
	for (const Run& run : data.runs)
		most = std::max(most, run.surface ? run.surface->reference_mesh_triangles : 0);
	return most;
}

std::string methodHtml(const ReportData& data)
{
	std::string html = "<h2>How it was measured</h2><ul>";
	html += "<li>Reference surface: the base surface displaced with the height map at mip 0, in double precision. Tessellated surface: the "
			"micro-triangles, computed on the CPU by the code that the device runs (equal bit for bit).</li>"
			"<li>Distance: from points of each surface to the nearest point of the other; of both directions the larger figure is given. Pixels: the "
			"distance seen face-on at its distance from the eye.</li>"
			"<li>Seen: one sample per place of the picture, evenly over it. Whole surface: by area, hidden parts too.</li>";
	html += fmt::format("<li>{} Searches for nearest points on the reference surface start from a mesh of {} triangles.</li>", samplingText(data),
						startTriangles(data));
	html +=
		"<li>Pictures: PSNR over red, green and blue as stored; SSIM after Wang, Bovik, Sheikh and Simoncelli (IEEE Transactions on Image Processing "
		"13(4), 2004) on luma, 11 x 11 Gaussian window; MS-SSIM after Wang, Simoncelli and Bovik (2003), five scales; silhouette: pixels that only "
		"one of the pictures covers.";
	std::set<std::string> references;
	for (const Run& run : data.runs)
		if (run.image && references.insert(run.reference.picture).second)
			html += fmt::format(" Reference at {}x{}: rate {:g} ({} micro-triangles).", run.setting.width, run.setting.height,
								run.reference.rate_granted, run.reference.micro_triangles);
	html += "</li><li>Time: GPU timestamps around everything that makes the picture; frames of a camera that stands still, or of every key of a path "
			"in turn, after warm-up.</li></ul><dl>";
	const auto fact = [&](std::string_view name, std::string_view value) {
		html += fmt::format("<dt>{}</dt><dd>{}</dd>", escaped(name), escaped(value));
	};
	fact("scene", data.scene);
	for (const auto& [name, value] : data.scene_facts)
		fact(name, value);
	fact("device", data.device);
	fact("driver", data.driver);
	fact("Vulkan", data.api);
	fact("tessera", data.version);
	return html + fmt::format("</dl><p>This report again:</p><pre>{}</pre>", escaped(data.command));
}

}  // namespace

Result<std::string> reportHtml(const std::filesystem::path& folder, const ReportData& data)
{
	TRY_ASSIGN(const std::string pictures, picturesJson(folder, data));
	const std::string title = fmt::format("Error against run time: {}", escaped(data.scene));
	std::string html =
		fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
					"content=\"width=device-width,initial-scale=1\"><link rel=\"icon\" href=\"data:,\"><title>{}</title><style>{}{}</style>"
					"</head><body><main><h1>{}</h1><p class=\"quiet\">{}, driver {}</p>",
					title, kPageStyle, chartStyle(), title, escaped(data.device), escaped(data.driver));
	html += adviceHtml(data) + plotsHtml(data) + originalHtml(data) + picturesHtml() + tableHtml(data) + numericsHtml(data) + leftOutHtml(data) +
			methodHtml(data);
	html += "</main><script type=\"application/json\" id=\"pictures\">" + pictures + "</script><script>";
	html += kPageScript;
	return html + "</script></body></html>\n";
}

}  // namespace tessera::report
