#include "layer/hazards.h"

#include "layer/report.h"

#include <algorithm>
#include <set>

namespace tessera::layer
{

namespace
{

constexpr VkPipelineStageFlags2 kStages = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR | VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR | VK_ACCESS_2_MEMORY_WRITE_BIT;
constexpr VkAccessFlags2 kAny = kWrites | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR | VK_ACCESS_2_MEMORY_READ_BIT;

bool orders(VkPipelineStageFlags2 from, VkAccessFlags2 written, VkPipelineStageFlags2 to, VkAccessFlags2 seen)
{
	return (from & kStages) && (to & kStages) && (written & kWrites) && (seen & kAny);
}

}  // namespace

bool ordersBuilds(VkPipelineStageFlags from, VkPipelineStageFlags to, uint32_t count, const VkMemoryBarrier* barriers, uint32_t buffer_count,
				  const VkBufferMemoryBarrier* buffers)
{
	const auto one = [&](const auto& barrier) {
		return orders(from, barrier.srcAccessMask, to, barrier.dstAccessMask);
	};
	return std::any_of(barriers, barriers + count, one) || std::any_of(buffers, buffers + buffer_count, one);
}

bool ordersBuilds(const VkDependencyInfo& dependency)
{
	const auto one = [](const auto& barrier) {
		return orders(barrier.srcStageMask, barrier.srcAccessMask, barrier.dstStageMask, barrier.dstAccessMask);
	};
	return std::any_of(dependency.pMemoryBarriers, dependency.pMemoryBarriers + dependency.memoryBarrierCount, one) ||
		   std::any_of(dependency.pBufferMemoryBarriers, dependency.pBufferMemoryBarriers + dependency.bufferMemoryBarrierCount, one);
}

void Hazards::begin(uint32_t epoch, const char* command)
{
	if (epoch != epoch_)
	{
		reads_.clear();
		writes_.clear();
	}
	epoch_ = epoch;
	command_ = command;
	current_.clear();
}

void Hazards::add(VkDeviceAddress address, VkDeviceSize size, const char* what, bool writes)
{
	if (size)
		current_.push_back({ address, address + size, what, command_, writes });
}

const Hazards::Access* Hazards::overlapping(const Accesses& earlier, const Access& access)
{
	auto entry = earlier.upper_bound(access.first);
	if (entry != earlier.begin() && std::prev(entry)->second.end > access.first)
		return &std::prev(entry)->second;
	return entry != earlier.end() && entry->first < access.end ? &entry->second : nullptr;
}

void Hazards::merge(Accesses& into, Access access)
{
	auto entry = into.upper_bound(access.first);
	if (entry != into.begin() && std::prev(entry)->second.end >= access.first)
		--entry;
	while (entry != into.end() && entry->second.first <= access.end)
	{
		access.first = std::min(access.first, entry->second.first);
		access.end = std::max(access.end, entry->second.end);
		entry = into.erase(entry);
	}
	into[access.first] = access;
}

void Hazards::end(Report& report)
{
	std::set<const char*> named;
	for (const Access& access : current_)
	{
		const Access* earlier = overlapping(writes_, access);
		if (!earlier && access.writes)
			earlier = overlapping(reads_, access);
		if (earlier && named.insert(access.what).second)
			report.violation("missing-barrier",
							 "{}: {} at {:#x} is {} while {} at {:#x} to {:#x} of an earlier command ({}) may not be done; right is a barrier from "
							 "ACCELERATION_STRUCTURE_BUILD, ACCELERATION_STRUCTURE_WRITE to ACCELERATION_STRUCTURE_BUILD, "
							 "ACCELERATION_STRUCTURE_READ | WRITE between them",
							 command_, access.what, access.first, access.writes ? "written" : "read", earlier->what, earlier->first, earlier->end,
							 earlier->command);
	}
	for (const Access& access : current_)
		merge(access.writes ? writes_ : reads_, access);
}

}  // namespace tessera::layer
