// How far the tessellated surface and the reference surface are apart: over the whole surface, and over what the camera sees.
#pragma once
#include "report/figures.h"
#include "report/micro_samples.h"
#include "report/progress.h"
#include "report/sampling.h"

namespace tessera::report
{

// Distances of one region, from each surface to the other and two-sided (per figure the larger). Pixels: at the camera, face-on.
// The mean and percentile of the whole surface are by its area, of what the camera sees by its pixels.
struct RegionError
{
	Figures to_tessellated_mesh, to_reference_mesh, mesh;  // mesh units
	Figures relative;                                      // of the diagonal of the scene's bounds
	Figures to_tessellated_px, to_reference_px, px;
	Figures normal_deg;  // angle between micro-triangles and reference surface
	uint64_t samples = 0;
	double change = 0;       // of any two-sided figure, relative, when the samples were doubled for the last time
	bool converged = false;  // `change` is at most SamplingLimits::change
};

// Doubles the samples until no figure (relative to the diagonal and in pixels) changes by more than limits.change, or limits.most is reached. The
// largest error is searched for from the largest samples uphill within their micro-triangles. Same input, same result. On all threads. Each sample
// takes about 10 us.
RegionError wholeSurfaceError(const SurfacePair& surfaces, double diagonal_world, const SamplingLimits& limits, Progress& progress);
RegionError visibleError(const SurfacePair& surfaces, double diagonal_world, const SamplingLimits& limits, Progress& progress);

// What is seen is a part of the whole: raises the largest errors of `whole` to those of `seen`, which looks closer where pixels are small.
void includeSeen(RegionError& whole, const RegionError& seen);

// The two-sided distance in pixels at the middle of every pixel of a smaller picture; negative where nothing is seen.
struct ErrorPicture
{
	uint32_t width = 0, height = 0;
	std::vector<float> px;
};
ErrorPicture errorPicture(const SurfacePair& surfaces, uint32_t most_width, Progress& progress);

}  // namespace tessera::report
