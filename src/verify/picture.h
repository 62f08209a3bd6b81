// Who is seen at every pixel, by identity: list indices differ from frame to frame, identities do not.
#pragma once
#include "verify/micro_set.h"

#include <compare>

namespace tessera::verify
{

// Instance, cluster, triangle, corners of the part in pattern order (of the whole triangle in full clusters), micro-triangle.
struct Identity
{
	std::array<uint32_t, 10> words = {};

	auto operator<=>(const Identity&) const = default;
	ClusterRef cluster() const { return { words[0], words[1] }; }
	uint32_t triangle() const { return words[2]; }
};
Identity identityOf(const MicroTriangle& t);
std::string describe(const Identity& identity);

struct VisiblePixel
{
	float depth = 0;  // reversed, nearer is larger; 0: background
	Identity identity;

	bool covered() const { return depth > 0; }
};

struct VisiblePicture
{
	uint32_t width_px = 0, height_px = 0;
	std::vector<VisiblePixel> pixels;  // rows top to bottom

	uint64_t covered() const;
};

// Adds what one round drew: `words` as readVisibility gives them, payloads resolved by that round's lists.
void addRound(const FrameDump& lists, const SceneOrder& order, std::span<const uint64_t> words, VisiblePicture& picture);

// Pixels that see something else. Another identity at equal depth (within `depth_room`, relative) is a tie (C4): counted, no violation.
CheckResult comparePictures(const VisiblePicture& expected, const VisiblePicture& found, const std::string& what, double depth_room = 0);

}  // namespace tessera::verify
