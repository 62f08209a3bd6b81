#include "frame/settle.h"

#include <algorithm>

namespace tessera
{

constexpr double kWindowSeconds = 0.2, kMostSeconds = 3;
constexpr double kSteady = 0.99;

void SettleWatch::add(double gpu_ms, double seconds)
{
	window_ms_.push_back(gpu_ms);
	given_up_ = seconds >= kMostSeconds;
	if (seconds - window_start_ < kWindowSeconds)
		return;
	endWindow();
	window_start_ = seconds;
}

void SettleWatch::endWindow()
{
	const auto middle = window_ms_.begin() + static_cast<ptrdiff_t>(window_ms_.size() / 2);
	std::nth_element(window_ms_.begin(), middle, window_ms_.end());
	const bool steady = last_median_ms_ > 0 && *middle >= kSteady * last_median_ms_;
	steady_windows_ = steady ? steady_windows_ + 1 : 0;
	last_median_ms_ = *middle;
	window_ms_.clear();
}

}  // namespace tessera
