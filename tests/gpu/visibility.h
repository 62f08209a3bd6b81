// Who is seen at every pixel, by identity: list indices differ from frame to frame, identities do not.
#pragma once
#include "gpu_test.h"

#include <array>
#include <compare>

namespace tessera::test
{

// Instance, cluster, triangle, domain corners of the part (the whole triangle in full clusters), micro-triangle.
struct Identity
{
	std::array<uint32_t, 10> words = {};

	auto operator<=>(const Identity&) const = default;
};
std::string describe(const Identity& identity);

struct VisiblePixel
{
	float depth = 0;  // 0: background
	Identity identity;

	bool covered() const { return depth > 0; }
};

// The frame's depth and payload images, resolved. Of paths that have none, kept_visibility, where the renderer was made with it; else empty.
std::vector<VisiblePixel> visibilityOf(const GpuFrame& frame);

struct VisibilityDifference
{
	size_t ties = 0;     // another identity at equal depth
	size_t others = 0;   // everything else
	std::string first;   // of the others
	size_t covered = 0;  // pixels that either covers
};
// `depth_tolerance`, relative: two pipelines of one device may interpolate depth with different last bits.
VisibilityDifference compareVisibility(const std::vector<VisiblePixel>& a, const std::vector<VisiblePixel>& b, uint32_t width_px,
									   double depth_tolerance = 0);

// The same pixels by another way: every micro-triangle of the reference, drawn in double precision on the host. Pixels within a small
// margin of an edge, or with two surfaces within a small margin of depth, are undecided.
struct ExpectedPixel
{
	bool decided = false;
	bool covered = false;
	Identity identity;
};
std::vector<ExpectedPixel> expectedVisibility(const GpuFrame& frame);

}  // namespace tessera::test
