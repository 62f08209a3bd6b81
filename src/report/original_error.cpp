#include "report/original_error.h"

#include "base/check.h"
#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace tessera::report
{

namespace
{

constexpr uint64_t kMostDescribedTriangles = 40'000'000;  // of the reference surface, over all instances

struct WorldSample
{
	WorldSpot spot;
	double distance = 0;
	double px_per_world = 0;
};

// From points of one surface to the other.
class OneWay
{
public:
	OneWay(const WorldSurface& from, const WorldSurface& to, const View& view)
		: from_(from), to_(to), view_(view), from_eye_(from.origin() - eyeOf(view))
	{}

	// Samples up to `end` of a sequence of points; those that there are stay.
	void measure(uint64_t end, Progress& progress)
	{
		const uint64_t first = samples_.size();
		samples_.resize(end);
		parallelFor((end - first + kSampleChunk - 1) / kSampleChunk, [&](size_t chunk) {
			const uint64_t from = first + chunk * kSampleChunk, to = std::min(end, from + kSampleChunk);
			for (uint64_t i = from; i < to; ++i)
				samples_[i] = sampleAt(from_.spotAt(numbersOfSequence(i)));
			progress.advance(to - from);
		});
	}

	Figures world() const
	{
		return figures([](const WorldSample& sample) { return sample.distance; });
	}
	Figures px() const
	{
		return figures([](const WorldSample& sample) { return sample.distance * sample.px_per_world; });
	}

private:
	WorldSample sampleAt(const WorldSpot& spot) const
	{
		const dvec3 point = from_.point(spot);
		return { spot, to_.distance(point), pxPerWorld(view_, from_eye_ + point) };
	}

	template <typename Height>
	Figures figures(const Height& height) const
	{
		std::vector<Weighted> values;
		values.reserve(samples_.size());
		for (const WorldSample& sample : samples_)
			values.push_back({ height(sample), 1 });
		Figures result = figuresOf(values);
		const auto climbFrom = [&](size_t i) {
			WorldSpot spot = samples_[i].spot;
			return climb(spot.weights, height(samples_[i]), [&](dvec2 weights) -> std::optional<double> {
				spot.weights = weights;
				return height(sampleAt(spot));
			});
		};
		result.max = largestByClimbing(
			samples_.size(), [&](size_t i) { return height(samples_[i]); }, climbFrom);
		return result;
	}

	const WorldSurface& from_;
	const WorldSurface& to_;
	const View& view_;
	dvec3 from_eye_;
	std::vector<WorldSample> samples_;
};

OriginalError errorOf(const OneWay& to_original, const OneWay& to_surface, double diagonal_world)
{
	OriginalError error;
	error.to_original_world = to_original.world();
	error.to_surface_world = to_surface.world();
	error.world = largerOf(error.to_original_world, error.to_surface_world);
	error.relative = scaled(error.world, 1 / diagonal_world);
	error.px = largerOf(to_original.px(), to_surface.px());
	return error;
}

}  // namespace

OriginalError originalError(const WorldSurface& surface, const WorldSurface& original, const View& view, double diagonal_world,
							const SamplingLimits& limits, Progress& progress, const std::string& what)
{
	CHECK(surface.origin() == original.origin(), "surfaces of different origins");
	if (!(surface.area() > 0))
		return {};
	OneWay to_original(surface, original, view), to_surface(original, surface, view);
	const auto measureUpTo = [&](uint64_t end, uint64_t before) {
		progress.begin(what, 2 * (end - before));
		to_original.measure(end, progress);
		to_surface.measure(end, progress);
		OriginalError error = errorOf(to_original, to_surface, diagonal_world);
		error.samples = 2 * end;
		return error;
	};
	OriginalError error = measureUpTo(limits.first, 0);
	error.change = 1;
	for (uint64_t asked = limits.first; !error.converged && 2 * asked <= limits.most; asked *= 2)
	{
		OriginalError finer = measureUpTo(2 * asked, asked);
		finer.change = std::max(relativeChange(error.relative, finer.relative, kLeastRelative), relativeChange(error.px, finer.px, kLeastPx));
		finer.converged = finer.change <= limits.change;
		error = finer;
	}
	progress.end();
	return error;
}

OriginalMeasure::OriginalMeasure(const WorldSurface& original, double diagonal_world, const SamplingLimits& limits)
	: original_(original), diagonal_world_(diagonal_world), limits_(limits)
{}

OriginalMeasure::CameraKey OriginalMeasure::keyOf(const View& view)
{
	const dvec3 eye = eyeOf(view);
	return { eye.x, eye.y, eye.z, view.focal_y, double(view.height_px), view.unit, view.near, view.distance_weight };
}

// Many instances of a mesh share the triangles that the surfaces may be made of.
void OriginalMeasure::describe(const reference::HostScene& scene, const View& view, const ReferenceSurface& surface)
{
	uint64_t triangles = 0;
	for (const Instance& instance : scene.built().instances)
		triangles += surface.trianglesOf(instance.mesh) ? surface.trianglesOf(instance.mesh)->triangles().size() : 0;
	const bool fits = triangles <= kMostDescribedTriangles;
	const double share = fits ? 1 : double(kMostDescribedTriangles) / double(triangles);
	const auto most = static_cast<uint32_t>(double(surface.triangleCount()) * share) + 1;
	if (fits)
		described_ = describedSurface(scene, surface, original_.origin());
	else
		described_ = describedSurface(scene, ReferenceSurface(scene, view, most), original_.origin());
	View flat = view;
	flat.displacement_scale = 0;
	base_ = describedSurface(scene, ReferenceSurface(scene, flat, scene.built().traits.has_pn ? most : 1), original_.origin());
}

const OriginalMeasure::Ends& OriginalMeasure::endsAt(const reference::HostScene& scene, const View& view, const ReferenceSurface& surface,
													 Progress& progress)
{
	const CameraKey key = keyOf(view);
	const auto known = std::find_if(ends_.begin(), ends_.end(), [&](const Ends& ends) { return ends.camera == key; });
	if (known != ends_.end())
		return *known;
	if (!described_)
		describe(scene, view, surface);
	const auto against = [&](const WorldSurface& end, const char* what) {
		return originalError(end, original_, view, diagonal_world_, limits_, progress, what);
	};
	ends_.push_back(
		{ key, against(*described_, "reference surface against the original"), against(*base_, "undisplaced surface against the original") });
	return ends_.back();
}

AgainstOriginal OriginalMeasure::measure(const reference::HostScene& scene, const View& view, const ReferenceSurface& surface,
										 const MicroScene& micro, Progress& progress)
{
	AgainstOriginal result;
	const Ends& ends = endsAt(scene, view, surface, progress);
	result.floor = ends.floor;
	result.undisplaced = ends.undisplaced;
	result.floor_triangles = described_->triangleCount();
	result.drawn = originalError(drawnSurface(scene, micro, original_.origin()), original_, view, diagonal_world_, limits_, progress,
								 "distances to and from the original");
	return result;
}

}  // namespace tessera::report
