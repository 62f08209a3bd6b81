// Metrics compared at equal error: what each takes for what the first takes, by the fronts of their runs.
#pragma once
#include "report/recommend.h"

namespace tessera::report
{

// What a run costs.
enum class Cost : uint8_t
{
	Time,       // median GPU time
	Triangles,  // micro-triangles drawn
};

// How one metric's runs do beside another's, of one raster path and picture size.
struct MetricComparison
{
	std::string metric, baseline;
	std::string raster;
	uint32_t width = 0, height = 0;
	Cost cost = Cost::Time;
	double ratio = 1;                  // cost over the baseline's at equal error: geometric mean over the errors that both reach
	double worst_ratio = 1;            // the largest there
	double least_px = 0, most_px = 0;  // the errors that both reach
};

// What `runs` (of one metric, raster path and size) cost at an error: interpolated between neighbours on their front, as a power of the error. None:
// outside of what the front reaches.
std::optional<double> costAt(std::span<const Run* const> runs, ErrorKind kind, Cost cost, double error_px);

// Every metric beside the first that was tried, wherever both have at least two runs on their fronts and errors in common above `kFloorPx`.
inline constexpr double kFloorPx = 1e-3;
std::vector<MetricComparison> compareMetrics(std::span<const Run> runs, ErrorKind kind, Cost cost);

// "detail takes 0.41 times the micro-triangles of edge at equal error (seen 99th percentile 0.2 to 1.7 px; at worst 0.9 times)"
std::string describe(const MetricComparison& comparison, ErrorKind kind);

}  // namespace tessera::report
