// Values over the last while: medians and plots of the Timings panel. Pure.
#pragma once
#include <cstddef>
#include <deque>
#include <vector>

namespace tessera::view
{

// Values with the time they came at, in the order of time.
class History
{
public:
	explicit History(double keep_s = 10) : keep_s_(keep_s) {}

	// Lets go of what is older than keep_s before now_s.
	void add(double now_s, double value);
	// The middle value (of two, the mean) of those within `window_s` before the newest; 0 when there is none.
	double median(double window_s = 1) const;
	// All kept values, oldest first.
	std::vector<float> values() const;
	bool empty() const { return entries_.empty(); }
	void clear() { entries_.clear(); }

private:
	struct Entry
	{
		double time_s, value;
	};
	double keep_s_;
	std::deque<Entry> entries_;
};

}  // namespace tessera::view
