#include "viewer/history.h"

#include <algorithm>

namespace tessera::view
{

void History::add(double now_s, double value)
{
	entries_.push_back({ now_s, value });
	while (entries_.front().time_s < now_s - keep_s_)
		entries_.pop_front();
}

double History::median(double window_s) const
{
	std::vector<double> values;
	for (const Entry& entry : entries_)
		if (entry.time_s >= entries_.back().time_s - window_s)
			values.push_back(entry.value);
	if (values.empty())
		return 0;
	std::sort(values.begin(), values.end());
	const size_t middle = values.size() / 2;
	return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::vector<float> History::values() const
{
	std::vector<float> values;
	for (const Entry& entry : entries_)
		values.push_back(static_cast<float>(entry.value));
	return values;
}

}  // namespace tessera::view
