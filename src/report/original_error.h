// How far what is drawn lies from the original: the model that a height map was made from.
#pragma once
#include "report/figures.h"
#include "report/micro_samples.h"
#include "report/progress.h"
#include "report/sampling.h"
#include "report/world_surface.h"

#include <array>

namespace tessera::report
{

// Distances between a surface and the original, from each to the other and two-sided (per figure the larger), over the whole of both, by area.
struct OriginalError
{
	Figures to_original_world, to_surface_world, world;  // world units
	Figures relative;                                    // of the diagonal of the scene's bounds
	Figures px;                                          // at the camera, face-on
	uint64_t samples = 0;                                // of both surfaces
	double change = 0;                                   // of any two-sided figure, relative, when the samples were doubled for the last time
	bool converged = false;                              // `change` is at most SamplingLimits::change
};

// What was drawn, and between which surfaces it lies: that which base and height maps describe, where finer rates lead, and the base alone.
struct AgainstOriginal
{
	OriginalError drawn;
	OriginalError floor;        // of the reference surface
	OriginalError undisplaced;  // of the base surface
	uint64_t floor_triangles = 0;
};

// Both surfaces have one origin, and an area. Doubles the samples, limits.first of each surface to begin with, until no two-sided figure (relative to
// the diagonal and in pixels) changes by more than limits.change, or limits.most is reached. The largest distances are searched for from the
// largest samples uphill within their triangles. Same input, same result. On all threads; each sample takes a few us.
OriginalError originalError(const WorldSurface& surface, const WorldSurface& original, const View& view, double diagonal_world,
							const SamplingLimits& limits, Progress& progress, const std::string& what);

// Base triangles of a scene over its instances that can be measured against an original: about 1 kB each.
inline constexpr uint64_t kMostBaseTriangles = 4'000'000;

// Measures runs of one scene against one original, and once per camera what does not depend on the run.
class OriginalMeasure
{
public:
	// Both must outlive it.
	OriginalMeasure(const WorldSurface& original, double diagonal_world, const SamplingLimits& limits = {});

	// `surface` and `micro` are of `scene` and `view`; scene and displacement are the same in every call.
	AgainstOriginal measure(const reference::HostScene& scene, const View& view, const ReferenceSurface& surface, const MicroScene& micro,
							Progress& progress);

private:
	// What pixels go by.
	using CameraKey = std::array<double, 8>;
	static CameraKey keyOf(const View& view);

	struct Ends
	{
		CameraKey camera;
		OriginalError floor, undisplaced;
	};
	void describe(const reference::HostScene& scene, const View& view, const ReferenceSurface& surface);
	const Ends& endsAt(const reference::HostScene& scene, const View& view, const ReferenceSurface& surface, Progress& progress);

	const WorldSurface& original_;
	double diagonal_world_;
	SamplingLimits limits_;
	std::optional<WorldSurface> described_, base_;
	std::vector<Ends> ends_;
};

}  // namespace tessera::report
