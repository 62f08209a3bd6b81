#include "report/page_original.h"

#include "report/report_charts.h"

#include <algorithm>

namespace tessera::report
{

namespace
{

constexpr double kNear = 1.05;  // of the floor: nearer than that, finer rates gain nothing against the original

// Runs of one picture size and metric from coarse to fine, one of each rate: raster paths draw the same surface.
std::vector<std::vector<const Run*>> curvesOf(const ReportData& data)
{
	std::vector<std::vector<const Run*>> curves;
	for (const Run& run : data.runs)
	{
		if (!hasOriginal(run))
			continue;
		const auto belongs = [&](const std::vector<const Run*>& curve) {
			const Setting &a = curve[0]->setting, &b = run.setting;
			return a.width == b.width && a.height == b.height && a.metric == b.metric;
		};
		auto curve = std::find_if(curves.begin(), curves.end(), belongs);
		if (curve == curves.end())
			curve = curves.insert(curves.end(), std::vector<const Run*>());
		if (std::none_of(curve->begin(), curve->end(), [&](const Run* other) { return other->setting.rate == run.setting.rate; }))
			curve->push_back(&run);
	}
	for (auto& curve : curves)
		std::stable_sort(curve.begin(), curve.end(), [](const Run* a, const Run* b) { return a->setting.rate > b->setting.rate; });
	return curves;
}

const AgainstOriginal& against(const Run& run)
{
	return *run.surface->original;
}

std::string percent(double share)
{
	return threeDigits(share * 100) + " %";
}

std::string describeCurve(const std::vector<const Run*>& curve)
{
	const Setting& first = curve[0]->setting;
	const OriginalError &coarse = against(*curve[0]).drawn, &fine = against(*curve.back()).drawn, &floor = against(*curve[0]).floor;
	std::string text = fmt::format("{}x{}, {}: ", first.width, first.height, first.metric);
	if (curve.size() == 1)
		text += fmt::format("at rate {:g} the distance to the original is {}", first.rate, threeDigits(coarse.world.rms));
	else
		text += fmt::format("from rate {:g} to {:g} the distance to the original goes from {} to {}", first.rate, curve.back()->setting.rate,
							threeDigits(coarse.world.rms), threeDigits(fine.world.rms));
	text += fmt::format(" world units (root mean square; {} of the diagonal, {} px). ", percent(fine.relative.rms), threeDigits(fine.px.rms));
	const auto near =
		std::find_if(curve.begin(), curve.end(), [&](const Run* run) { return against(*run).drawn.world.rms <= kNear * floor.world.rms; });
	if (near == curve.end())
		return text + fmt::format("None of the rates tried comes within 5 % of the floor{}.",
								  fine.world.rms < coarse.world.rms ? ": a finer one still gains" : "");
	return text +
		   fmt::format("From rate {:g} on it is within 5 % of the floor: finer rates come nearer to the reference surface, hardly to the original.",
					   (*near)->setting.rate);
}

// Independent of rate, metric and picture.
std::string describeEnds(const AgainstOriginal& ends)
{
	const double floor = ends.floor.world.rms, undisplaced = ends.undisplaced.world.rms;
	std::string text =
		fmt::format("The floor: the reference surface itself lies {} world units from the original (root mean square; largest {}), and finer "
					"rates lead there. Without displacement it would be {}",
					threeDigits(floor), threeDigits(ends.floor.world.max), threeDigits(undisplaced));
	if (floor < undisplaced)
		return text + fmt::format(": the height maps take {} of it away.", percent(1 - floor / undisplaced));
	return text + ": the height maps bring it no nearer. Are their factor and offset right, and is the original in the scene's place?";
}

std::string samplingText(const ReportData& data)
{
	uint64_t least = 0, most = 0;
	double change = 0;
	std::string unsteady;
	for (const Run& run : data.runs)
	{
		if (!hasOriginal(run))
			continue;
		const OriginalError& error = against(run).drawn;
		least = least == 0 ? error.samples : std::min(least, error.samples);
		most = std::max(most, error.samples);
		if (error.converged)
			change = std::max(change, error.change);
		else
			unsteady += fmt::format("{}{} ({:.1f} %)", unsteady.empty() ? "" : "; ", escaped(run.setting.label()), error.change * 100);
	}
	std::string text = fmt::format("Distances between the triangles that are drawn and those of the original, in the world, from points of each "
								   "(evenly by area) to the nearest point of "
								   "the other; the larger figure is given. Samples were doubled until no figure changed by more than 1 %: {} to {} "
								   "of both surfaces; the largest "
								   "change that was left is {:.2f} %.",
								   least, most, change * 100);
	return unsteady.empty() ? text : text + fmt::format(" Not reached with the most samples that are taken: {}.", unsteady);
}

}  // namespace

bool hasOriginal(const Run& run)
{
	return run.failure.empty() && run.surface && run.surface->original;
}

std::vector<std::string> describeOriginal(const ReportData& data)
{
	std::vector<std::string> sentences;
	for (const auto& curve : curvesOf(data))
	{
		if (sentences.empty())
			sentences.push_back(describeEnds(against(*curve[0])));
		sentences.push_back(describeCurve(curve));
	}
	return sentences;
}

std::string originalHtml(const ReportData& data)
{
	const std::vector<std::string> sentences = describeOriginal(data);
	if (!data.original || sentences.empty())
		return "";
	const auto measured = std::find_if(data.runs.begin(), data.runs.end(), hasOriginal);
	std::string html = fmt::format(
		"<h2 id=\"original\">Against the original</h2><p>The model that the height maps were made from: <code>{}</code>, {} triangles.</p>",
		escaped(data.original->path), data.original->triangles);
	for (const std::string& sentence : sentences)
		html += fmt::format("<p>{}</p>", escaped(sentence));
	html += "<div class=\"grid2\">";
	for (const NamedChart& chart : originalCharts(data))
		html += "<div>" + chart.svg + "</div>";
	return html + fmt::format("</div><p class=\"quiet\">{} The reference surface as {} triangles.</p>", samplingText(data),
							  against(*measured).floor_triangles);
}

}  // namespace tessera::report
