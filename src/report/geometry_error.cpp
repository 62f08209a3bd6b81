#include "report/geometry_error.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tessera::report
{

namespace
{

using Spots = std::function<std::optional<MicroSpot>(uint64_t)>;
using Height = std::function<double(const Sample&)>;

// Samples first..end-1 of a sequence of spots, in order.
std::vector<Sample> measureSpots(const SurfacePair& surfaces, const Spots& spots, uint64_t first, uint64_t end, Progress& progress)
{
	std::vector<std::vector<Sample>> chunks((end - first + kSampleChunk - 1) / kSampleChunk);
	parallelFor(chunks.size(), [&](size_t chunk) {
		const uint64_t from = first + chunk * kSampleChunk, to = std::min(end, from + kSampleChunk);
		for (uint64_t i = from; i < to; ++i)
			if (const std::optional<MicroSpot> spot = spots(i))
				if (const std::optional<Sample> sample = surfaces.measure(*spot))
					chunks[chunk].push_back(*sample);
		progress.advance(to - from);
	});
	std::vector<Sample> samples;
	for (const auto& chunk : chunks)
		samples.insert(samples.end(), chunk.begin(), chunk.end());
	return samples;
}

double largestHeight(const SurfacePair& surfaces, const std::vector<Sample>& samples, const Height& height)
{
	const auto climbFrom = [&](size_t i) {
		MicroSpot spot = samples[i].spot;
		return climb(spot.weights, height(samples[i]), [&](dvec2 weights) {
			spot.weights = weights;
			const std::optional<Sample> sample = surfaces.measure(spot);
			return sample ? std::optional(height(*sample)) : std::nullopt;
		});
	};
	return largestByClimbing(
		samples.size(), [&](size_t i) { return height(samples[i]); }, climbFrom);
}

Figures figuresOver(const std::vector<Sample>& samples, const Height& height, const Height& weight)
{
	std::vector<Weighted> values;
	values.reserve(samples.size());
	for (const Sample& sample : samples)
		values.push_back({ height(sample), weight(sample) });
	return figuresOf(values);
}

// `by_area`: reference samples weigh by how much of that surface they stand for, which lies above the tessellated one unevenly.
RegionError regionError(const SurfacePair& surfaces, const std::vector<Sample>& samples, bool by_area, double diagonal)
{
	const Height one = [](const Sample&) {
		return 1.0;
	};
	const Height reference_weight = by_area ? Height([](const Sample& s) { return s.area_ratio; }) : one;
	const Height to_tessellated = [](const Sample& s) {
		return s.to_tessellated;
	};
	const Height to_reference = [](const Sample& s) {
		return s.to_reference;
	};
	const auto inPx = [](const Height& length) -> Height {
		return [&length](const Sample& s) {
			return s.px(length(s));
		};
	};
	const auto figures = [&](const Height& height, const Height& weight) {
		Figures result = figuresOver(samples, height, weight);
		result.max = std::max(result.max, largestHeight(surfaces, samples, height));
		return result;
	};
	RegionError error;
	error.samples = samples.size();
	error.to_tessellated_mesh = figures(to_tessellated, reference_weight);
	error.to_reference_mesh = figures(to_reference, one);
	error.to_tessellated_px = figures(inPx(to_tessellated), reference_weight);
	error.to_reference_px = figures(inPx(to_reference), one);
	error.mesh = largerOf(error.to_tessellated_mesh, error.to_reference_mesh);
	error.px = largerOf(error.to_tessellated_px, error.to_reference_px);
	const auto relative = [&](const Height& length) -> Height {
		return [&length, diagonal](const Sample& s) {
			return length(s) * s.world_per_mesh / diagonal;
		};
	};
	error.relative = largerOf(figures(relative(to_tessellated), reference_weight), figures(relative(to_reference), one));
	error.normal_deg = figuresOver(
		samples, [](const Sample& s) { return s.normal_deviation; }, one);
	return error;
}

RegionError untilSteady(const SurfacePair& surfaces, const Spots& spots, bool by_area, double diagonal, const SamplingLimits& limits,
						Progress& progress, const std::string& what)
{
	progress.begin(what, limits.first);
	std::vector<Sample> samples = measureSpots(surfaces, spots, 0, limits.first, progress);
	RegionError error = regionError(surfaces, samples, by_area, diagonal);
	error.change = 1;
	for (uint64_t asked = limits.first; !samples.empty() && !error.converged && 2 * asked <= limits.most; asked *= 2)
	{
		progress.begin(what, asked);
		const std::vector<Sample> more = measureSpots(surfaces, spots, asked, 2 * asked, progress);
		samples.insert(samples.end(), more.begin(), more.end());
		RegionError finer = regionError(surfaces, samples, by_area, diagonal);
		finer.change = std::max(relativeChange(error.relative, finer.relative, kLeastRelative), relativeChange(error.px, finer.px, kLeastPx));
		finer.converged = finer.change <= limits.change;
		error = finer;
	}
	progress.end();
	return error;
}

}  // namespace

RegionError wholeSurfaceError(const SurfacePair& surfaces, double diagonal_world, const SamplingLimits& limits, Progress& progress)
{
	const Spots spots = [&](uint64_t i) {
		const dvec3 numbers = numbersOfSequence(i);
		return surfaces.area() > 0 ? std::optional(surfaces.spotAt(numbers.x, { numbers.y, numbers.z })) : std::nullopt;
	};
	return untilSteady(surfaces, spots, true, diagonal_world, limits, progress, "distances over the whole surface");
}

RegionError visibleError(const SurfacePair& surfaces, double diagonal_world, const SamplingLimits& limits, Progress& progress)
{
	const dvec2 size(surfaces.view().width_px, surfaces.view().height_px);
	const Spots spots = [&](uint64_t i) {
		return surfaces.spotSeenAt(pointOfSequence(i) * size);
	};
	return untilSteady(surfaces, spots, false, diagonal_world, limits, progress, "distances over what the camera sees");
}

void includeSeen(RegionError& whole, const RegionError& seen)
{
	for (Figures RegionError::*figures :
		 { &RegionError::to_tessellated_mesh, &RegionError::to_reference_mesh, &RegionError::mesh, &RegionError::relative,
		   &RegionError::to_tessellated_px, &RegionError::to_reference_px, &RegionError::px, &RegionError::normal_deg })
		(whole.*figures).max = std::max((whole.*figures).max, (seen.*figures).max);
}

ErrorPicture errorPicture(const SurfacePair& surfaces, uint32_t most_width, Progress& progress)
{
	const View& view = surfaces.view();
	ErrorPicture picture;
	picture.width = std::min(view.width_px, most_width);
	picture.height = std::max(1u, static_cast<uint32_t>(uint64_t(view.height_px) * picture.width / view.width_px));
	picture.px.assign(size_t(picture.width) * picture.height, -1);
	const dvec2 step = dvec2(view.width_px, view.height_px) / dvec2(picture.width, picture.height);
	progress.begin("error at every pixel", picture.height);
	parallelFor(picture.height, [&](size_t y) {
		for (uint32_t x = 0; x < picture.width; ++x)
			if (const auto spot = surfaces.spotSeenAt((dvec2(x, double(y)) + 0.5) * step))
				if (const auto sample = surfaces.measure(*spot))
					picture.px[y * picture.width + x] = static_cast<float>(sample->largestPx());
		progress.advance();
	});
	progress.end();
	return picture;
}

}  // namespace tessera::report
