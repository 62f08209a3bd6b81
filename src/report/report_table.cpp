#include "report/report_table.h"

#include "report/page_original.h"

#include <algorithm>

namespace tessera::report
{

namespace
{

std::string exact(double value)
{
	return fmt::format("{}", value);
}

std::string rounded(double value)
{
	return threeDigits(value);
}

std::string grouped(uint64_t value)
{
	std::string text = fmt::format("{}", value);
	for (auto place = static_cast<int>(text.size()) - 3; place > 0; place -= 3)
		text.insert(static_cast<size_t>(place), "\u202f");
	return text;
}

bool drawn(const Run& run)
{
	return run.failure.empty();
}

// Cells of a number of the run, of its surface (both regions need samples) and of its picture.
template <auto value>
std::string number(const Run& run)
{
	return drawn(run) ? exact(double(value(run))) : "";
}
template <auto value>
std::string shortNumber(const Run& run)
{
	return drawn(run) ? rounded(double(value(run))) : "";
}
template <auto value>
std::string count(const Run& run)
{
	return drawn(run) ? fmt::format("{}", value(run)) : "";
}
template <auto value>
std::string shownCount(const Run& run)
{
	return drawn(run) ? grouped(value(run)) : "";
}
template <auto value>
std::string seen(const Run& run)
{
	return run.surface && run.surface->visible.samples > 0 ? exact(double(value(run.surface->visible))) : "";
}
template <auto value>
std::string shownSeen(const Run& run)
{
	return run.surface && run.surface->visible.samples > 0 ? rounded(double(value(run.surface->visible))) : "";
}
template <auto value>
std::string whole(const Run& run)
{
	return run.surface ? exact(double(value(run.surface->whole))) : "";
}
template <auto value>
std::string shownWhole(const Run& run)
{
	return run.surface ? rounded(double(value(run.surface->whole))) : "";
}
template <auto value>
std::string image(const Run& run)
{
	return run.image ? exact(double(value(*run.image))) : "";
}

template <auto value>
std::string original(const Run& run)
{
	return hasOriginal(run) ? exact(double(value(*run.surface->original))) : "";
}
template <auto value>
std::string shownOriginal(const Run& run)
{
	return hasOriginal(run) ? rounded(double(value(*run.surface->original))) : "";
}

std::string psnr(const Run& run)
{
	return run.image && run.image->psnr_db ? exact(*run.image->psnr_db) : "";
}
std::string shownPsnr(const Run& run)
{
	if (!run.image)
		return "";
	return run.image->psnr_db ? fmt::format("{:.1f}", *run.image->psnr_db) : "equal";
}
std::string msSsim(const Run& run)
{
	return run.image && run.image->ms_ssim ? exact(*run.image->ms_ssim) : "";
}
std::string shownMsSsim(const Run& run)
{
	return run.image && run.image->ms_ssim ? fmt::format("{:.4f}", *run.image->ms_ssim) : "";
}
std::string shownSsim(const Run& run)
{
	return run.image ? fmt::format("{:.4f}", run.image->ssim) : "";
}
std::string shownRate(const Run& run)
{
	return run.isCoarsened() ? fmt::format("{:g} → {:.3g}", run.setting.rate, run.rate_granted) : fmt::format("{:g}", run.setting.rate);
}
std::string shownQuartiles(const Run& run)
{
	return drawn(run) ? threeDigits(run.gpu_ms.lower_quartile) + "–" + threeDigits(run.gpu_ms.upper_quartile) : "";
}

#define OF_RUN(expression) \
	[](const Run& r) {     \
		return expression; \
	}
#define OF_REGION(expression)  \
	[](const RegionError& r) { \
		return expression;     \
	}
#define OF_ORIGINAL(expression)    \
	[](const AgainstOriginal& r) { \
		return expression;         \
	}
#define OF_IMAGE(expression)  \
	[](const ImageError& r) { \
		return expression;    \
	}

const Column kColumns[] = {
	{ "size", "picture", "pixels", OF_RUN(fmt::format("{}x{}", r.setting.width, r.setting.height)) },
	{ "rate", "rate", "tessellation rate, pixels per segment; an arrow: coarsened because a list was full", OF_RUN(exact(r.setting.rate)),
	  shownRate },
	{ "raster", "raster", "who finds visibility", OF_RUN(r.setting.raster) },
	{ "metric", "metric", "what decides the segments of an edge", OF_RUN(r.setting.metric) },
	{ "rate_granted", "", "", number<OF_RUN(r.rate_granted)> },
	{ "gpu_ms_median", "ms", "GPU time per frame, median", number<OF_RUN(r.gpu_ms.median)>, shortNumber<OF_RUN(r.gpu_ms.median)> },
	{ "gpu_ms_min", "least", "least GPU time of a frame, ms", number<OF_RUN(r.gpu_ms.min)>, shortNumber<OF_RUN(r.gpu_ms.min)> },
	{ "gpu_ms_lower_quartile", "spread", "half of the frames lie between these, ms", number<OF_RUN(r.gpu_ms.lower_quartile)>, shownQuartiles },
	{ "gpu_ms_upper_quartile", "", "", number<OF_RUN(r.gpu_ms.upper_quartile)> },
	{ "gpu_ms_max", "", "", number<OF_RUN(r.gpu_ms.max)> },
	{ "frames", "frames", "frames that were timed", count<OF_RUN(r.frames)> },
	{ "micro_triangles", "micro-triangles", "drawn", count<OF_RUN(r.counts.micro_triangles)>, shownCount<OF_RUN(r.counts.micro_triangles)> },
	{ "part_triangles", "parts", "part triangles", count<OF_RUN(r.counts.part_triangles)>, shownCount<OF_RUN(r.counts.part_triangles)> },
	{ "split_triangles", "splits", "split triangles", count<OF_RUN(r.counts.split_triangles)>, shownCount<OF_RUN(r.counts.split_triangles)> },
	{ "bytes", "MiB", "lists, geometry, textures and images", count<OF_RUN(r.bytes.total())>,
	  shortNumber<OF_RUN(double(r.bytes.total()) / (1 << 20))> },
	{ "seen_p99_px", "p99 px", "distance of the surfaces over what the camera sees, 99th percentile, pixels", seen<OF_REGION(r.px.p99)>,
	  shownSeen<OF_REGION(r.px.p99)> },
	{ "seen_max_px", "max px", "the same, largest", seen<OF_REGION(r.px.max)>, shownSeen<OF_REGION(r.px.max)> },
	{ "seen_rms_px", "rms px", "the same, root mean square", seen<OF_REGION(r.px.rms)>, shownSeen<OF_REGION(r.px.rms)> },
	{ "seen_max_mesh", "max, mesh units", "the same, largest, mesh units", seen<OF_REGION(r.mesh.max)>, shownSeen<OF_REGION(r.mesh.max)> },
	{ "seen_rms_mesh", "", "", seen<OF_REGION(r.mesh.rms)> },
	{ "seen_p99_mesh", "", "", seen<OF_REGION(r.mesh.p99)> },
	{ "seen_normal_p99_deg", "normal, °", "angle between micro-triangles and surface, 99th percentile", seen<OF_REGION(r.normal_deg.p99)>,
	  shownSeen<OF_REGION(r.normal_deg.p99)> },
	{ "seen_normal_rms_deg", "", "", seen<OF_REGION(r.normal_deg.rms)> },
	{ "seen_samples", "", "", seen<OF_REGION(double(r.samples))> },
	{ "seen_change", "", "", seen<OF_REGION(r.change)> },
	{ "whole_p99_px", "whole p99 px", "over the whole surface, hidden or not, 99th percentile, pixels", whole<OF_REGION(r.px.p99)>,
	  shownWhole<OF_REGION(r.px.p99)> },
	{ "whole_max_px", "", "", whole<OF_REGION(r.px.max)> },
	{ "whole_rms_px", "", "", whole<OF_REGION(r.px.rms)> },
	{ "whole_max_mesh", "whole max, mesh units", "over the whole surface, largest, mesh units", whole<OF_REGION(r.mesh.max)>,
	  shownWhole<OF_REGION(r.mesh.max)> },
	{ "whole_rms_mesh", "whole rms, mesh units", "over the whole surface, root mean square, mesh units", whole<OF_REGION(r.mesh.rms)>,
	  shownWhole<OF_REGION(r.mesh.rms)> },
	{ "whole_p99_mesh", "", "", whole<OF_REGION(r.mesh.p99)> },
	{ "whole_max_relative", "of diagonal", "over the whole surface, largest, relative to the diagonal of the bounds",
	  whole<OF_REGION(r.relative.max)>, shownWhole<OF_REGION(r.relative.max)> },
	{ "whole_rms_relative", "", "", whole<OF_REGION(r.relative.rms)> },
	{ "whole_normal_p99_deg", "", "", whole<OF_REGION(r.normal_deg.p99)> },
	{ "whole_samples", "", "", whole<OF_REGION(double(r.samples))> },
	{ "whole_change", "", "", whole<OF_REGION(r.change)> },
	{ "original_rms_world", "original rms", "distance to the original, over the whole surface, root mean square, world units",
	  original<OF_ORIGINAL(r.drawn.world.rms)>, shownOriginal<OF_ORIGINAL(r.drawn.world.rms)> },
	{ "original_p99_world", "original p99", "the same, 99th percentile, world units", original<OF_ORIGINAL(r.drawn.world.p99)>,
	  shownOriginal<OF_ORIGINAL(r.drawn.world.p99)> },
	{ "original_max_world", "original max", "the same, largest, world units", original<OF_ORIGINAL(r.drawn.world.max)>,
	  shownOriginal<OF_ORIGINAL(r.drawn.world.max)> },
	{ "original_rms_relative", "original of diagonal", "the same, root mean square, relative to the diagonal of the scene's bounds",
	  original<OF_ORIGINAL(r.drawn.relative.rms)>, shownOriginal<OF_ORIGINAL(r.drawn.relative.rms)> },
	{ "original_p99_relative", "", "", original<OF_ORIGINAL(r.drawn.relative.p99)> },
	{ "original_max_relative", "", "", original<OF_ORIGINAL(r.drawn.relative.max)> },
	{ "original_rms_px", "original rms px", "the same, root mean square, pixels", original<OF_ORIGINAL(r.drawn.px.rms)>,
	  shownOriginal<OF_ORIGINAL(r.drawn.px.rms)> },
	{ "original_p99_px", "", "", original<OF_ORIGINAL(r.drawn.px.p99)> },
	{ "original_max_px", "", "", original<OF_ORIGINAL(r.drawn.px.max)> },
	{ "original_samples", "", "", original<OF_ORIGINAL(double(r.drawn.samples))> },
	{ "original_change", "", "", original<OF_ORIGINAL(r.drawn.change)> },
	{ "original_floor_rms_world", "floor rms", "distance of the reference surface to the original, root mean square, world units",
	  original<OF_ORIGINAL(r.floor.world.rms)>, shownOriginal<OF_ORIGINAL(r.floor.world.rms)> },
	{ "original_floor_p99_world", "", "", original<OF_ORIGINAL(r.floor.world.p99)> },
	{ "original_floor_max_world", "", "", original<OF_ORIGINAL(r.floor.world.max)> },
	{ "original_floor_rms_px", "", "", original<OF_ORIGINAL(r.floor.px.rms)> },
	{ "original_floor_p99_px", "", "", original<OF_ORIGINAL(r.floor.px.p99)> },
	{ "original_floor_max_px", "", "", original<OF_ORIGINAL(r.floor.px.max)> },
	{ "original_undisplaced_rms_world", "", "", original<OF_ORIGINAL(r.undisplaced.world.rms)> },
	{ "psnr_db", "PSNR, dB", "against the picture of the reference rate", psnr, shownPsnr },
	{ "ssim", "SSIM", "against the picture of the reference rate", image<OF_IMAGE(r.ssim)>, shownSsim },
	{ "ms_ssim", "MS-SSIM", "against the picture of the reference rate", msSsim, shownMsSsim },
	{ "silhouette_pixels", "silhouette", "pixels covered in one of the two pictures only", image<OF_IMAGE(double(r.silhouette_pixels))> },
	{ "reference_rate", "against rate", "rate of the picture that PSNR, SSIM and silhouettes are against", number<OF_RUN(r.reference.rate_granted)>,
	  shortNumber<OF_RUN(r.reference.rate_granted)> },
	{ "failure", "", "", OF_RUN(r.failure) },
};

bool isOfOriginal(const Column& column)
{
	return column.key.starts_with("original_");
}

std::string csvCell(const std::string& text)
{
	if (text.find_first_of(",\"\n") == std::string::npos)
		return text;
	std::string quoted = "\"";
	for (const char c : text)
		quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
	return quoted + "\"";
}

}  // namespace

std::span<const Column> reportColumns()
{
	return kColumns;
}

std::vector<const Column*> pageColumns(const ReportData& data)
{
	const bool has_original = std::any_of(data.runs.begin(), data.runs.end(), hasOriginal);
	std::vector<const Column*> columns;
	for (const Column& column : kColumns)
		if (!column.head.empty() && (has_original || !isOfOriginal(column)))
			columns.push_back(&column);
	return columns;
}

std::string reportCsv(const ReportData& data)
{
	std::string text;
	for (const Column& column : kColumns)
		text += fmt::format("{}{}", text.empty() ? "" : ",", column.key);
	text += '\n';
	for (const Run& run : data.runs)
	{
		bool first = true;
		for (const Column& column : kColumns)
		{
			text += (first ? "" : ",") + csvCell(column.cell(run));
			first = false;
		}
		text += '\n';
	}
	return text;
}

}  // namespace tessera::report
