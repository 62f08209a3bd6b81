// Decides in which frames looking for what is hidden pays (DESIGN.md, contract C5). Pure. The picture never depends on it.
#pragma once
#include <cstdint>

namespace tessera
{

// What a frame that looked for what is hidden found, and what it took.
struct OcclusionOutcome
{
	uint64_t items = 0;     // parts and full clusters that the frame had: about the same work each
	uint64_t left_out = 0;  // hidden in both phases
	double raster_ms = 0;   // of the items that were not
	double looking_ms = 0;  // of the passes that look; 0: the device has no timers
};

// Looks in every frame while it pays. After kPatience frames in a row that did not it rests, longer each time, and then looks again.
class OcclusionController
{
public:
	static constexpr uint32_t kPatience = 4;
	static constexpr uint32_t kShortestRest = 16, kLongestRest = 256;

	// Whether the next frame should look.
	bool looks() const { return resting_ == 0; }
	// After a frame. `outcome`: of a frame that looked with a frame before it to look at; nullptr: of any other.
	void endFrame(const OcclusionOutcome* outcome);

private:
	uint32_t resting_ = 0;  // frames left to rest
	uint32_t in_vain_ = 0;  // frames in a row that did not pay
	uint32_t next_rest_ = kShortestRest;
};

}  // namespace tessera
