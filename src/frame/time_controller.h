// Finds, frame by frame, the finest rate that keeps a GPU time: `--max-ms`. Pure.
#pragma once
#include <cstdint>

namespace tessera
{

// A frame takes a fixed time and one that falls with the rate, by what the scene and device make of it: the slope of log time against log
// rate is learnt from the frames themselves. Coarsens at once, by as much as is needed; refines only after several frames with room to spare,
// so that the rate rests while the view does (hysteresis).
class TimeController
{
public:
	static constexpr double kAim = 0.93;       // of the budget: where a correction tries to land
	static constexpr double kRoom = 0.86;      // frames below this part of the budget let the rate become finer ...
	static constexpr uint32_t kPatience = 4;   // ... when so many come in a row
	static constexpr double kLargestStep = 2;  // of the rate, from one frame to the next
	static constexpr double kFinest_px = 1.0 / 16, kCoarsest_px = 256;

	// `budget_ms` above 0; `rate_px` to begin with, within the finest and the coarsest.
	TimeController(double budget_ms, double rate_px);

	// For the next frame, pixels.
	double rate() const { return rate_px_; }
	// After a frame that was drawn at `rate_px` (frames in flight may still have an older one).
	void endFrame(double rate_px, double gpu_ms);

	// True when the last frames stayed between kRoom and the budget, or no rate can bring them there.
	bool isSettled() const { return settled_frames_ >= kPatience; }

private:
	void learnSlope(double rate_px, double gpu_ms);
	void correct(double gpu_ms);

	double budget_ms_;
	double rate_px_;
	double slope_ = -1;  // of log time over log rate
	double last_rate_px_ = 0, last_ms_ = 0;
	uint32_t frames_with_room_ = 0;
	uint32_t settled_frames_ = 0;
};

}  // namespace tessera
