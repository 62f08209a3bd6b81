#include "frame/lists.h"

#include "frame/rate_controller.h"
#include "plan/conditions.h"
#include "tessellation/rate_search.h"

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
	if (!kBuffered.holds(input))
		return parts;
	constexpr uint32_t kLeastParts = std::min(RASTER_BATCH_VERTICES / BATCH_MAX_VERTICES, RASTER_BATCH_TRIANGLES / BATCH_MAX_TRIANGLES);
	return parts / kLeastParts + 2 * (parts / BATCH_WINDOW + 1);
}

using Capacities = std::array<uint32_t, LIST_COUNT>;

// What the user says goes before everything; then batches follow from parts.
Capacities withAsked(Capacities capacities, const PlanInput& input)
{
	for (const auto& [name, capacity] : input.options.capacities)
		capacities[findList(name)->index] = capacity;
	for (const ListDesc& list : kLists)
		capacities[list.index] = std::clamp(capacities[list.index], list.least_capacity, mostEntries(list));
	capacities[LIST_BATCHES] = std::max(capacities[LIST_BATCHES], mostBatches(capacities[LIST_PART_TRIANGLES], input));
	return capacities;
}

uint32_t usefulEntries(const ListDesc& list, uint64_t capacity, const PlanInput& input)
{
	const uint64_t bound = sceneBound(list, input);
	return static_cast<uint32_t>(std::min<uint64_t>(bound > 0 ? std::min(capacity, bound) : capacity, mostEntries(list)));
}

Capacities defaultCapacities(const PlanInput& input)
{
	Capacities capacities = {};
	for (const ListDesc& list : kLists)
		capacities[list.index] = usefulEntries(list, list.default_capacity, input);
	if (kClusters.holds(input))
		capacities[LIST_MICRO_VERTICES] = std::min(capacities[LIST_MICRO_VERTICES], input.options.most_cluster_vertices);
	return withAsked(capacities, input);
}

// Entries per part triangle where a budget is shared out, in quarters: at a few pixels per segment a part has some 30 micro-triangles.
constexpr uint64_t kSplitQuarters = 1, kVertexQuarters = 4 * 24, kTriangleQuarters = 4 * 32;

Capacities capacitiesFor(uint64_t parts, uint64_t clusters, const PlanInput& input)
{
	Capacities capacities = {};
	for (const ListDesc& list : kLists)
		capacities[list.index] = usefulEntries(list, clusters, input);
	capacities[LIST_PART_TRIANGLES] = static_cast<uint32_t>(parts);
	capacities[LIST_SPLIT_TRIANGLES] = static_cast<uint32_t>(parts * kSplitQuarters / 4);
	capacities[LIST_BATCHES] = 1;
	capacities[LIST_MICRO_VERTICES] = static_cast<uint32_t>(parts * kVertexQuarters / 4);
	capacities[LIST_EXPANDED_TRIANGLES] = static_cast<uint32_t>(parts * kTriangleQuarters / 4);
	return withAsked(capacities, input);
}

// The largest n up to `most` that holds, when it holds for all below as well; 0 when none does.
template <typename Holds>
uint64_t largest(uint64_t most, const Holds& holds)
{
	uint64_t low = 0, high = most;
	while (low < high)
	{
		const uint64_t middle = (low + high + 1) / 2;
		if (holds(middle))
			low = middle;
		else
			high = middle - 1;
	}
	return low;
}

// Clusters first, in up to a quarter of the budget (more of them than that are drawn in rounds); then as many parts as fit, and
// the other lists in proportion.
Result<Capacities> capacitiesWithin(uint64_t bytes, const PlanInput& input)
{
	const uint64_t least = bytesOfLists(capacitiesFor(1, 1, input), input);
	if (bytes < least)
		return fail(ExitCode::Usage, "--budget: {} bytes are too few, the smallest lists of this scene and raster path take {}", bytes, least);
	const uint64_t clusters_bytes = least + (bytes - least) / (input.options.rate > 0 || kKeepsVertices.holds(input) ? 4 : 1);
	const uint64_t clusters =
		std::max<uint64_t>(1, largest(kIndexLimit, [&](uint64_t n) { return bytesOfLists(capacitiesFor(1, n, input), input) <= clusters_bytes; }));
	const uint64_t parts =
		std::max<uint64_t>(1, largest(kIndexLimit, [&](uint64_t n) { return bytesOfLists(capacitiesFor(n, clusters, input), input) <= bytes; }));
	return capacitiesFor(parts, clusters, input);
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

bool isFixed(const ListDesc& list, const RenderOptions& options)
{
	return options.lists_bytes > 0 || options.capacities.count(std::string(list.name)) > 0;
}

uint64_t listBytes(const ListDesc& list, uint32_t capacity)
{
	return uint64_t(list.record_bytes) * capacity;
}

uint64_t listBufferBytes(const ListDesc& list, uint32_t capacity)
{
	return listBytes(list, capacity) + (list.index == LIST_MICRO_VERTICES ? list.record_bytes : 0);
}

uint64_t bytesOfLists(const std::array<uint32_t, LIST_COUNT>& capacities, const PlanInput& input)
{
	const bool tessellates = input.options.rate > 0;
	uint64_t bytes = LIST_COUNT * sizeof(ListHead) + sizeof(FrameCounts) + 16;
	for (const ListDesc& list : kLists)
	{
		const bool of_parts = list.index == LIST_SPLIT_TRIANGLES || list.index == LIST_PART_TRIANGLES || list.index == LIST_BATCHES;
		const bool needed = of_parts                                ? tessellates
							: list.index == LIST_MICRO_VERTICES     ? kKeepsVertices.holds(input)
							: list.index == LIST_EXPANDED_TRIANGLES ? kExpands.holds(input)
																	: true;
		bytes += needed ? listBufferBytes(list, capacities[list.index]) + 16 : 0;  // buffers are whole words of 16 bytes
	}
	if (tessellates)
		bytes += kMostRateSteps * sizeof(RateStep) + uint64_t(capacities[LIST_PART_TRIANGLES]) * sizeof(PartPlace) + 16 +
				 (uint64_t(capacities[LIST_PART_TRIANGLES]) / BATCH_WINDOW + 1) * sizeof(uint32_t) + 16;  // window_seen, or window_vertices
	if (tessellates && usesSoft(input) && (input.device.most_small_rate_px > 0 || input.forces(kSmallFirst)))
		bytes += (uint64_t(capacities[LIST_BATCHES]) + capacities[LIST_FULL_CLUSTERS]) * sizeof(uint32_t) + 16;
	return bytes;
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
	return input.options.lists_bytes > 0 ? capacitiesWithin(input.options.lists_bytes, input) : defaultCapacities(input);
}

}  // namespace tessera
