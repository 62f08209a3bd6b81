#include "report/run.h"

#include <algorithm>
#include <cmath>

namespace tessera::report
{

using nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Figures, max, rms, p99)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TimeFigures, median, min, max, lower_quartile, upper_quartile)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PassFigures, name, gpu_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunCounts, micro_triangles, part_triangles, split_triangles, full_clusters, visible_clusters, covered_pixels)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunBytes, lists, geometry, textures, images)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RegionError, to_tessellated_mesh, to_reference_mesh, mesh, relative, to_tessellated_px, to_reference_px, px,
								   normal_deg, samples, change, converged)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Numerics, vertices, not_finite, worst_base_ulp, worst_displaced_ulp, worst_share_of_bound, shared_edges,
								   differing_edges, edge_points, zero_area_triangles, first_problem)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OriginalError, to_original_world, to_surface_world, world, relative, px, samples, change, converged)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AgainstOriginal, drawn, floor, undisplaced, floor_triangles)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReferencePicture, rate_wanted, rate_granted, micro_triangles, picture)

namespace
{

template <typename T>
void readOptional(const json& from, std::optional<T>& value)
{
	value = from.is_null() ? std::nullopt : std::optional(from.get<T>());
}

template <typename T>
json optionalJson(const std::optional<T>& value)
{
	return value ? json(*value) : json();
}

}  // namespace

static void to_json(json& to, const Setting& setting)
{
	to = { { "rate", setting.rate },   { "raster", setting.raster }, { "metric", setting.metric },
		   { "width", setting.width }, { "height", setting.height }, { "forced", setting.forced } };
}

static void from_json(const json& from, Setting& setting)
{
	from.at("rate").get_to(setting.rate);
	from.at("raster").get_to(setting.raster);
	from.at("metric").get_to(setting.metric);
	from.at("width").get_to(setting.width);
	from.at("height").get_to(setting.height);
	setting.forced = from.value("forced", "");
}

static void to_json(json& to, const SurfaceErrors& errors)
{
	to = { { "whole", errors.whole },
		   { "visible", errors.visible },
		   { "numerics", errors.numerics },
		   { "original", optionalJson(errors.original) },
		   { "micro_triangles", errors.micro_triangles },
		   { "reference_mesh_triangles", errors.reference_mesh_triangles } };
}

static void from_json(const json& from, SurfaceErrors& errors)
{
	from.at("whole").get_to(errors.whole);
	from.at("visible").get_to(errors.visible);
	from.at("numerics").get_to(errors.numerics);
	readOptional(from.value("original", json()), errors.original);
	from.at("micro_triangles").get_to(errors.micro_triangles);
	from.at("reference_mesh_triangles").get_to(errors.reference_mesh_triangles);
}

static void to_json(json& to, const ImageError& error)
{
	to = { { "psnr_db", optionalJson(error.psnr_db) },       { "ssim", error.ssim },
		   { "ms_ssim", optionalJson(error.ms_ssim) },       { "differing_pixels", error.differing_pixels },
		   { "silhouette_pixels", error.silhouette_pixels }, { "covered_pixels", error.covered_pixels } };
}

static void from_json(const json& from, ImageError& error)
{
	readOptional(from.at("psnr_db"), error.psnr_db);
	from.at("ssim").get_to(error.ssim);
	readOptional(from.at("ms_ssim"), error.ms_ssim);
	from.at("differing_pixels").get_to(error.differing_pixels);
	from.at("silhouette_pixels").get_to(error.silhouette_pixels);
	from.at("covered_pixels").get_to(error.covered_pixels);
}

TimeFigures timeFigures(std::vector<double> gpu_ms)
{
	if (gpu_ms.empty())
		return {};
	std::sort(gpu_ms.begin(), gpu_ms.end());
	// Between the two nearest values, as the median of an even count is.
	const auto quantile = [&](double share) {
		const double place = share * double(gpu_ms.size() - 1);
		const auto below = static_cast<size_t>(place);
		const size_t above = std::min(below + 1, gpu_ms.size() - 1);
		return gpu_ms[below] + (gpu_ms[above] - gpu_ms[below]) * (place - double(below));
	};
	return { quantile(0.5), gpu_ms.front(), gpu_ms.back(), quantile(0.25), quantile(0.75) };
}

std::string Setting::label() const
{
	return fmt::format("rate {}, {}, {}, {}x{}{}{}", rate, metric, raster, width, height, forced.empty() ? "" : ", forced ", forced);
}

namespace
{

// Adds a camera's figures; finishFigures makes means of them.
void addFigures(Figures& sum, const Figures& figures)
{
	sum.max = std::max(sum.max, figures.max);
	sum.rms += figures.rms * figures.rms;
	sum.p99 += figures.p99;
}

void finishFigures(Figures& sum, size_t count)
{
	sum.rms = std::sqrt(sum.rms / double(count));
	sum.p99 /= double(count);
}

template <typename Error>
void addSampling(Error& sum, const Error& error)
{
	sum.samples += error.samples;
	sum.change = std::max(sum.change, error.change);
	sum.converged = sum.converged && error.converged;
}

RegionError regionAlongPath(std::span<const SurfaceErrors> cameras, RegionError SurfaceErrors::*region)
{
	constexpr Figures RegionError::*kFigures[] = {
		&RegionError::to_tessellated_mesh, &RegionError::to_reference_mesh, &RegionError::mesh, &RegionError::relative,
		&RegionError::to_tessellated_px,   &RegionError::to_reference_px,   &RegionError::px,   &RegionError::normal_deg
	};
	RegionError result;
	result.converged = true;
	for (const SurfaceErrors& camera : cameras)
	{
		const RegionError& error = camera.*region;
		for (const auto figures : kFigures)
			addFigures(result.*figures, error.*figures);
		addSampling(result, error);
	}
	for (const auto figures : kFigures)
		finishFigures(result.*figures, cameras.size());
	return result;
}

OriginalError originalAlongPath(std::span<const SurfaceErrors> cameras, OriginalError AgainstOriginal::*surface)
{
	constexpr Figures OriginalError::*kFigures[] = { &OriginalError::to_original_world, &OriginalError::to_surface_world, &OriginalError::world,
													 &OriginalError::relative, &OriginalError::px };
	OriginalError result;
	result.converged = true;
	for (const SurfaceErrors& camera : cameras)
	{
		const OriginalError& error = *camera.original.*surface;
		for (const auto figures : kFigures)
			addFigures(result.*figures, error.*figures);
		addSampling(result, error);
	}
	for (const auto figures : kFigures)
		finishFigures(result.*figures, cameras.size());
	return result;
}

Numerics numericsAlongPath(std::span<const SurfaceErrors> cameras)
{
	Numerics result;
	for (const SurfaceErrors& camera : cameras)
	{
		const Numerics& own = camera.numerics;
		result.vertices += own.vertices;
		result.not_finite += own.not_finite;
		result.worst_base_ulp = std::max(result.worst_base_ulp, own.worst_base_ulp);
		result.worst_displaced_ulp = std::max(result.worst_displaced_ulp, own.worst_displaced_ulp);
		result.worst_share_of_bound = std::max(result.worst_share_of_bound, own.worst_share_of_bound);
		result.shared_edges += own.shared_edges;
		result.differing_edges += own.differing_edges;
		result.edge_points += own.edge_points;
		result.zero_area_triangles += own.zero_area_triangles;
		if (result.first_problem.empty())
			result.first_problem = own.first_problem;
	}
	return result;
}

}  // namespace

SurfaceErrors alongPath(std::span<const SurfaceErrors> cameras)
{
	if (cameras.size() == 1)
		return cameras[0];
	SurfaceErrors result;
	result.whole = regionAlongPath(cameras, &SurfaceErrors::whole);
	result.visible = regionAlongPath(cameras, &SurfaceErrors::visible);
	result.numerics = numericsAlongPath(cameras);
	if (std::all_of(cameras.begin(), cameras.end(), [](const SurfaceErrors& camera) { return camera.original.has_value(); }))
		result.original = { originalAlongPath(cameras, &AgainstOriginal::drawn), originalAlongPath(cameras, &AgainstOriginal::floor),
							originalAlongPath(cameras, &AgainstOriginal::undisplaced), cameras[0].original->floor_triangles };
	for (const SurfaceErrors& camera : cameras)
	{
		result.micro_triangles += camera.micro_triangles;
		result.reference_mesh_triangles = std::max(result.reference_mesh_triangles, camera.reference_mesh_triangles);
	}
	result.micro_triangles /= cameras.size();
	return result;
}

json originalErrorJson(const OriginalError& error)
{
	return error;
}

json runJson(const Run& run)
{
	json result = { { "setting", run.setting },
					{ "failure", run.failure },
					{ "rate_granted", run.rate_granted },
					{ "every_factor_one", run.every_factor_one },
					{ "rounds", run.rounds },
					{ "cameras", run.cameras },
					{ "frames", run.frames },
					{ "warmup", run.warmup },
					{ "gpu_ms", run.gpu_ms },
					{ "passes", run.passes },
					{ "counts", run.counts },
					{ "bytes", run.bytes },
					{ "surface", optionalJson(run.surface) },
					{ "image", optionalJson(run.image) },
					{ "reference", run.reference },
					{ "picture", run.picture },
					{ "heat", run.heat } };
	result["bytes"]["total"] = run.bytes.total();
	return result;
}

Result<Run> runFromJson(const json& from, const std::string& where)
{
	try
	{
		Run run;
		from.at("setting").get_to(run.setting);
		from.at("failure").get_to(run.failure);
		from.at("rate_granted").get_to(run.rate_granted);
		from.at("every_factor_one").get_to(run.every_factor_one);
		from.at("rounds").get_to(run.rounds);
		from.at("cameras").get_to(run.cameras);
		from.at("frames").get_to(run.frames);
		from.at("warmup").get_to(run.warmup);
		from.at("gpu_ms").get_to(run.gpu_ms);
		from.at("passes").get_to(run.passes);
		from.at("counts").get_to(run.counts);
		from.at("bytes").get_to(run.bytes);
		readOptional(from.at("surface"), run.surface);
		readOptional(from.at("image"), run.image);
		from.at("reference").get_to(run.reference);
		from.at("picture").get_to(run.picture);
		from.at("heat").get_to(run.heat);
		return run;
	}
	catch (const json::exception& error)
	{
		return badInput("{}: not a run of a report: {}", where, error.what());
	}
}

}  // namespace tessera::report
