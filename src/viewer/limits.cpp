#include "viewer/limits.h"

#include "frame/lists.h"

#include <algorithm>

namespace tessera::view
{

Fill fillOf(uint64_t wanted, uint64_t capacity)
{
	if (wanted > capacity)
		return Fill::Full;
	return wanted > 0 && wanted * 10 >= capacity * 8 ? Fill::Tight : Fill::Roomy;
}

void HighWater::add(std::span<const ListStats> lists)
{
	for (const ListStats& list : lists)
		most_[list.name] = std::max({ most_[list.name], list.wanted, uint64_t(list.peak) });
}

uint64_t HighWater::of(const std::string& list) const
{
	const auto found = most_.find(list);
	return found == most_.end() ? 0 : found->second;
}

std::map<std::string, uint32_t> HighWater::fittingCapacities() const
{
	std::map<std::string, uint32_t> capacities;
	for (const auto& [name, most] : most_)
	{
		const ListDesc* list = findList(name);
		// Batches follow from parts.
		if (list && list->index != LIST_BATCHES)
			capacities[name] = static_cast<uint32_t>(std::clamp<uint64_t>(most + most / 8, list->least_capacity, mostEntries(*list)));
	}
	return capacities;
}

std::string coarseningWarning(const FrameResult& result)
{
	if (result.coarsening == 0 && !result.every_factor_one)
		return {};
	std::string lists;
	for (const ListStats& list : result.lists)
		if (list.peak > list.capacity && list.name != "batches")  // which follow from parts
			lists += fmt::format("{}{}", lists.empty() ? "" : ", ", list.name);
	const std::string granted = result.every_factor_one ? "every factor is 1" : fmt::format("{:.4g} px granted", result.rate_granted);
	return fmt::format("Coarser than asked for: {:.4g} px wanted, {}{}{}", result.rate_wanted, granted, lists.empty() ? "" : "; too small: ", lists);
}

}  // namespace tessera::view
