// When the times of a device's frames can be trusted: a GPU that was idle, while a scene was loaded or errors were measured, clocks up slowly
// (docs/performance.md), so frames are drawn until they get no faster.
#pragma once
#include "plan/pass.h"

#include <vector>

namespace tessera
{

class SettleWatch
{
public:
	explicit SettleWatch(const DeviceTraits& device) : has_clock_(!device.is_cpu) {}

	// A frame that took `gpu_ms` on the device ended `seconds` after the first one began.
	void add(double gpu_ms, double seconds);

	// Twice in a row the median of a fifth of a second was no more than a hundredth less than that of the one before, or three seconds are over. At
	// once on a processor.
	bool isSettled() const { return !has_clock_ || steady_windows_ >= 2 || given_up_; }

private:
	void endWindow();

	bool has_clock_;
	bool given_up_ = false;
	double window_start_ = 0;    // seconds
	double last_median_ms_ = 0;  // of the window before; 0: there is none
	std::vector<double> window_ms_;
	int steady_windows_ = 0;
};

}  // namespace tessera
