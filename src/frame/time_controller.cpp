#include "frame/time_controller.h"

#include "base/check.h"

#include <algorithm>
#include <cmath>

namespace tessera
{

namespace
{

// Micro-triangles grow with the square of the fineness, and a frame's fixed part hides some or nearly all of that.
constexpr double kSteepest = -2.2, kFlattest = -0.25;

}  // namespace

TimeController::TimeController(double budget_ms, double rate_px) : budget_ms_(budget_ms), rate_px_(std::clamp(rate_px, kFinest_px, kCoarsest_px))
{
	CHECK(budget_ms > 0 && rate_px > 0, "a budget of {} ms, a rate of {} px", budget_ms, rate_px);
}

void TimeController::endFrame(double rate_px, double gpu_ms)
{
	if (!(gpu_ms > 0) || !(rate_px > 0))
		return;
	learnSlope(rate_px, gpu_ms);
	// A frame of another rate says nothing of the one that was chosen since.
	if (std::abs(std::log(rate_px / rate_px_)) > 1e-4)
		return;
	const bool over = gpu_ms > budget_ms_, room = gpu_ms < kRoom * budget_ms_;
	frames_with_room_ = room ? frames_with_room_ + 1 : 0;
	const bool at_end = (over && rate_px_ >= kCoarsest_px) || (room && rate_px_ <= kFinest_px);
	if (at_end || (!over && !room))
	{
		++settled_frames_;
		return;
	}
	settled_frames_ = 0;
	if (over || frames_with_room_ >= kPatience)
		correct(gpu_ms);
}

void TimeController::learnSlope(double rate_px, double gpu_ms)
{
	const double apart = last_rate_px_ > 0 ? std::log(rate_px / last_rate_px_) : 0;
	// Of frames of nearly one rate only noise would be learnt.
	if (std::abs(apart) > 0.05)
		slope_ = std::clamp(std::log(gpu_ms / last_ms_) / apart, kSteepest, kFlattest);
	last_rate_px_ = rate_px;
	last_ms_ = gpu_ms;
}

void TimeController::correct(double gpu_ms)
{
	const double step = std::clamp(std::pow(kAim * budget_ms_ / gpu_ms, 1 / slope_), 1 / kLargestStep, kLargestStep);
	rate_px_ = std::clamp(rate_px_ * step, kFinest_px, kCoarsest_px);
	frames_with_room_ = 0;
}

}  // namespace tessera
