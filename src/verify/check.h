// What a check of verify says: how often a promise was broken, where it was worst, and what was looked at.
#pragma once
#include "shared/geometry.h"

#include <array>
#include <map>
#include <set>
#include <string>

namespace tessera::verify
{

// The promises, in the order of the report. Contracts: DESIGN.md, section 4.
inline constexpr std::string_view kWatertight = "watertight";        // C1
inline constexpr std::string_view kNoHoles = "no_holes";             // C2: every base triangle covered exactly once
inline constexpr std::string_view kNoLeaks = "no_leaks";             // C1 in the picture: no background within the silhouette
inline constexpr std::string_view kConservative = "conservative";    // C3
inline constexpr std::string_view kDeterministic = "deterministic";  // C4
inline constexpr std::string_view kPaths = "path_against_path";
inline constexpr std::string_view kFinite = "finite_and_right";
inline constexpr std::string_view kDevices = "device_against_device";

constexpr DomainPoint kNoPoint = { NO_INDEX, NO_INDEX };

// Where something is wrong; NO_INDEX: does not apply.
struct Place
{
	ClusterRef cluster = { NO_INDEX, NO_INDEX };
	uint32_t triangle = NO_INDEX;
	DomainPoint point = kNoPoint;
	std::string what;           // what is wrong there
	std::string frame;          // camera, rate and raster path
	uint32_t pixel = NO_INDEX;  // of the picture, row by row
};
std::string describe(const Place& place);

// Something that is wrong as a whole, or at a pixel that shows no triangle.
Place nowhere(std::string what, uint32_t pixel = NO_INDEX);

struct CheckResult
{
	uint64_t violations = 0;
	double worst = 0;                       // size of the worst one, in the check's own measure
	Place place;                            // of the worst one
	std::map<std::string, uint64_t> sums;   // what was looked at and counted
	std::map<std::string, double> largest;  // what was measured

	// Where violations are, for the picture: base triangles (instance, cluster, triangle) and pixels; at most kMostMarks of each.
	static constexpr size_t kMostMarks = 100'000;
	std::set<std::array<uint32_t, 3>> marked_triangles;
	std::set<uint32_t> marked_pixels;

	void violation(double size, const Place& at);
	void measure(const std::string& name, double value);
	// Adds what another frame, path or part of the scene gave.
	void merge(const CheckResult& other);
	// Says in which frame the worst violation is.
	void setFrame(const std::string& frame);
};

}  // namespace tessera::verify
