#include "frame/lists.h"

#include "plan/conditions.h"

#include <algorithm>

namespace tessera
{

namespace
{

constexpr uint32_t kMillion = 1u << 20;
constexpr uint32_t kIndexLimit = (1u << 24) - 1;  // the payload's index has 24 bits

constexpr ListDesc kLists[] = {
	{ "cluster_groups", LIST_CLUSTER_GROUPS, 12, kMillion, 1 },
	{ "visible_clusters", LIST_VISIBLE_CLUSTERS, 8, kMillion, CLUSTER_GROUP_SIZE },
	{ "full_clusters", LIST_FULL_CLUSTERS, sizeof(FullCluster), kMillion, CLUSTER_GROUP_SIZE },
	{ "split_triangles", LIST_SPLIT_TRIANGLES, 24, kMillion / 4, 1 },
	{ "part_triangles", LIST_PART_TRIANGLES, 24, kMillion, 1 },
	{ "batches", LIST_BATCHES, sizeof(Batch), 1, 1 },
	{ "micro_vertices", LIST_MICRO_VERTICES, 16, kMillion, 128 * CLUSTER_GROUP_SIZE },
	{ "expanded_triangles", LIST_EXPANDED_TRIANGLES, 16, kMillion, 128 * CLUSTER_GROUP_SIZE },
};

// Most entries that the scene itself can ask for, whatever the rate: 0 = no such bound.
uint64_t sceneBound(const ListDesc& list, const PlanInput& input)
{
	const uint64_t clusters = input.sizes.instanced_clusters;
	switch (list.index)
	{
	case LIST_CLUSTER_GROUPS:
		return clusters / CLUSTER_GROUP_SIZE + input.sizes.instances;
	case LIST_VISIBLE_CLUSTERS:
	case LIST_FULL_CLUSTERS:
		return clusters;
	default:
		return 0;
	}
}

// Batches that this many parts can need at most: batches never decide the rate. Parts are packed in windows, in two phases; a
// batch that is not the last of its window and phase holds at least as many parts as of the largest patterns fit.
uint32_t mostBatches(uint32_t parts, const PlanInput& input)
{
	if (!usesSoft(input))
		return parts;
	constexpr uint32_t kLeastParts = std::min(RASTER_BATCH_VERTICES / BATCH_MAX_VERTICES, RASTER_BATCH_TRIANGLES / BATCH_MAX_TRIANGLES);
	return parts / kLeastParts + 2 * (parts / BATCH_WINDOW + 1);
}

}  // namespace

uint32_t mostEntries(const ListDesc& list)
{
	return growsOnDemand(list) ? 0x0fffffff : kIndexLimit;
}

bool growsOnDemand(const ListDesc& list)
{
	return list.index == LIST_MICRO_VERTICES || list.index == LIST_EXPANDED_TRIANGLES;
}

std::span<const ListDesc> listDescs()
{
	return kLists;
}

const ListDesc* findList(std::string_view name)
{
	const auto found = std::find_if(std::begin(kLists), std::end(kLists), [&](const ListDesc& list) { return list.name == name; });
	return found == std::end(kLists) ? nullptr : found;
}

uint64_t listBytes(const ListDesc& list, uint32_t capacity)
{
	return uint64_t(list.record_bytes) * capacity;
}

Result<std::array<uint32_t, LIST_COUNT>> listCapacities(const PlanInput& input)
{
	for (const auto& [name, capacity] : input.options.capacities)
	{
		const ListDesc* list = findList(name);
		if (!list)
			return fail(ExitCode::Usage, "--capacity {}: no such list; `tessera info --print-plan` names them", name);
		if (capacity < list->least_capacity || capacity > mostEntries(*list))
			return fail(ExitCode::Usage, "--capacity {}={}: must lie between {} and {}", name, capacity, list->least_capacity, mostEntries(*list));
	}
	std::array<uint32_t, LIST_COUNT> capacities = {};
	for (const ListDesc& list : kLists)
	{
		uint64_t capacity = list.default_capacity;
		if (const uint64_t bound = sceneBound(list, input))
			capacity = std::min(capacity, bound);
		const auto asked = input.options.capacities.find(std::string(list.name));
		if (asked != input.options.capacities.end())
			capacity = asked->second;
		capacities[list.index] = static_cast<uint32_t>(std::max<uint64_t>(capacity, list.least_capacity));
	}
	capacities[LIST_BATCHES] = std::max(capacities[LIST_BATCHES], mostBatches(capacities[LIST_PART_TRIANGLES], input));
	return capacities;
}

}  // namespace tessera
