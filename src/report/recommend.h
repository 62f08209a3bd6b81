// Which runs are worth having, and which of them to take.
#pragma once
#include "report/run.h"

#include <span>

namespace tessera::report
{

// An error that runs are judged by.
enum class ErrorKind : uint8_t
{
	SeenP99,  // pixels, over what the camera sees
	SeenMax,
	SeenRms,
	WholeP99,  // pixels, over the whole surface
	WholeMax,
};
inline constexpr ErrorKind kErrorKinds[] = { ErrorKind::SeenP99, ErrorKind::SeenMax, ErrorKind::SeenRms, ErrorKind::WholeP99, ErrorKind::WholeMax };
std::string_view nameOf(ErrorKind kind);  // "99th percentile, seen"
std::string_view keyOf(ErrorKind kind);   // "seen_p99": for file names and keys

// None: the run failed, or its surface was not measured.
std::optional<double> errorOf(const Run& run, ErrorKind kind);

// Indices of the runs that no other beats: none is both faster (median) and of smaller error. By time. Runs of different picture sizes are
// not compared: `runs` of one size.
std::vector<size_t> paretoFront(std::span<const Run* const> runs, ErrorKind kind);

// max_error_px: of the largest error seen. Under max_ms the run with the smallest 99th percentile, seen, is the best.
struct Limits
{
	std::optional<double> max_error_px;
	std::optional<double> max_ms;
};

// One answer per picture size and limit, in words.
struct Advice
{
	std::string text;
	const Run* run = nullptr;  // none fits
};
std::vector<Advice> recommend(std::span<const Run> runs, const Limits& limits);

// Runs by picture size, in the order that the sizes first occur.
std::vector<std::vector<const Run*>> bySize(std::span<const Run> runs);

}  // namespace tessera::report
