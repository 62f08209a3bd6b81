// What the host remembers of the coarsening j of a frame: the granted rate is rate x 2^(j/16) (DESIGN.md, contract C2). The device finds j
// (rate_search); here is only where the next frame starts, and how many rounds it takes when no rate helps. Pure.
#pragma once
#include <cstdint>
#include <optional>

namespace tessera
{

struct Attempt
{
	uint32_t coarsening = 0;  // j that the frame is planned for: the finest that it can get
	uint32_t rounds = 1;      // the frame is drawn in this many parts, one after the other
};

// What an attempt found.
struct AttemptOutcome
{
	bool fits = true;           // everything was drawn
	bool rate_can_help = true;  // if not: a coarser rate might, clusters being no problem
	uint32_t coarsening = 0;    // j of what was drawn, or was to be; the largest of the rounds
};

class RateController
{
public:
	static constexpr uint32_t kMostCoarsening = 16 * 40;  // 2^40 times the rate: after that every factor is 1

	// Starts a frame. `same_view`: camera, rate and capacities are those of the frame before. Then it starts with what that one ended
	// with, otherwise at the asked rate: j depends on the view alone, not on the way to it.
	void beginFrame(bool same_view);
	Attempt next() const { return attempt_; }
	// Takes the outcome of next(); true when this attempt is the frame. Every round of a frame has the same rate, so a round that needs a
	// coarser one makes the frame start again there.
	bool accept(const AttemptOutcome& outcome);

private:
	Attempt attempt_;
};

// Candidates of rate_search, at most: every j.
inline constexpr uint32_t kMostRateSteps = RateController::kMostCoarsening + 1;

}  // namespace tessera
