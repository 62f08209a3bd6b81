// Decides the one coarsening j of a frame: the granted rate is rate x 2^(j/16) (DESIGN.md, contract C2). Pure.
#pragma once
#include <cstdint>
#include <optional>

namespace tessera
{

struct Attempt
{
	uint32_t coarsening = 0;
	bool every_factor_one = false;  // beyond every j: nothing is tessellated
	uint32_t rounds = 1;            // the frame is drawn in this many parts, one after the other
};

// What an attempt found.
struct AttemptOutcome
{
	bool fits = false;
	double worst_ratio = 1;          // largest wanted / capacity over the lists that the rate decides
	bool clusters_overflow = false;  // a list that no rate can relieve (clusters) wanted more than it holds
};

// Searches the smallest j that fits: first upwards by what the overflow suggests, then between the last that failed and the
// first that fit. Remembers j over frames; a still camera that fits keeps it, one that changed starts anew below it.
class RateController
{
public:
	static constexpr uint32_t kMostCoarsening = 16 * 40;  // 2^40 times the rate: after that every factor is 1

	// Starts a frame. `same_view`: camera, rate and capacities are those of the frame before.
	void beginFrame(bool same_view);
	Attempt next() const { return attempt_; }
	// Takes the outcome of next(); true when this attempt is the frame.
	bool accept(const AttemptOutcome& outcome);

private:
	Attempt attempt_;
	uint32_t step_ = 0;               // last move upwards
	std::optional<uint32_t> failed_;  // largest j known not to fit
	std::optional<uint32_t> fitted_;  // smallest j known to fit
};

}  // namespace tessera
