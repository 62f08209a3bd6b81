#include "verify/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera::verify
{

std::string describe(const Place& place)
{
	std::string text;
	if (place.cluster.instance != NO_INDEX)
		text += fmt::format("instance {} cluster {} ", place.cluster.instance, place.cluster.cluster);
	if (place.triangle != NO_INDEX)
		text += fmt::format("triangle {} ", place.triangle);
	if (place.point.u != NO_INDEX)
		text += fmt::format("point ({}, {}) ", place.point.u, place.point.v);
	if (!text.empty())
		text.back() = ':';
	text += (text.empty() ? "" : " ") + place.what;
	return place.frame.empty() ? text : text + " [" + place.frame + "]";
}

Place nowhere(std::string what, uint32_t pixel)
{
	Place place;
	place.what = std::move(what);
	place.pixel = pixel;
	return place;
}

void CheckResult::violation(double size, const Place& at)
{
	if (at.triangle != NO_INDEX && marked_triangles.size() < kMostMarks)
		marked_triangles.insert({ at.cluster.instance, at.cluster.cluster, at.triangle });
	if (at.pixel != NO_INDEX && marked_pixels.size() < kMostMarks)
		marked_pixels.insert(at.pixel);
	// Whatever is not a number is as bad as can be.
	if (violations++ == 0 || size > worst || (std::isnan(size) && !std::isnan(worst)))
	{
		worst = size;
		place = at;
	}
}

void CheckResult::measure(const std::string& name, double value)
{
	const auto [found, is_new] = largest.try_emplace(name, value);
	if (!is_new && (value > found->second || std::isnan(value)))
		found->second = value;
}

void CheckResult::merge(const CheckResult& other)
{
	if (other.violations > 0 && (violations == 0 || other.worst > worst || std::isnan(other.worst)))
	{
		worst = other.worst;
		place = other.place;
	}
	violations += other.violations;
	if (marked_triangles.size() < kMostMarks)
		marked_triangles.insert(other.marked_triangles.begin(), other.marked_triangles.end());
	if (marked_pixels.size() < kMostMarks)
		marked_pixels.insert(other.marked_pixels.begin(), other.marked_pixels.end());
	for (const auto& [name, count] : other.sums)
		sums[name] += count;
	for (const auto& [name, value] : other.largest)
		measure(name, value);
}

void CheckResult::setFrame(const std::string& frame)
{
	if (violations > 0)
		place.frame = frame;
}

}  // namespace tessera::verify
