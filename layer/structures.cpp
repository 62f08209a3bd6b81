#include "layer/structures.h"

#include "layer/device.h"

#include <algorithm>

namespace tessera::layer
{

void Structures::discard(Device& device, const BottomLevel& structure)
{
	device.next.DestroyAccelerationStructureKHR(device.handle, structure.handle, nullptr);
	device.lookup->rows.give(structure.first_row, structure.row_count);
	device.lookup->geometry_indices.give(structure.first_index, structure.index_count);
}

void Structures::drop(Device& device, const TopLevel& structure)
{
	device.lookup->slots.give(structure.first_slot, structure.slot_count);
}

void Structures::put(Device& device, VkDeviceAddress address, BottomLevel structure)
{
	memoryEnded(device, address, address + structure.record_bytes);
	const std::lock_guard guard(lock_);
	bottom_[address] = std::move(structure);
}

void Structures::putCopy(Device& device, VkDeviceAddress address, BottomLevel structure)
{
	{
		const std::lock_guard guard(lock_);
		for (auto& [where, other] : bottom_)
			if (other.serial == structure.serial)
				other.row_count = other.index_count = 0;
	}
	structure.row_count = structure.index_count = 0;
	put(device, address, std::move(structure));
}

const BottomLevel* Structures::find(VkDeviceAddress address) const
{
	const std::lock_guard guard(lock_);
	const auto found = bottom_.find(address);
	return found == bottom_.end() ? nullptr : &found->second;
}

void Structures::moved(Device& device, VkDeviceAddress from, VkDeviceAddress to)
{
	if (from == to)
		return;
	BottomLevel structure;
	{
		const std::lock_guard guard(lock_);
		const auto found = bottom_.find(from);
		if (found == bottom_.end())
			return;
		structure = std::move(found->second);
		bottom_.erase(found);
	}
	put(device, to, std::move(structure));
}

void Structures::memoryEnded(Device& device, VkDeviceAddress first, VkDeviceAddress end)
{
	const std::lock_guard guard(lock_);
	auto entry = bottom_.lower_bound(first);
	if (entry != bottom_.begin() && std::prev(entry)->first + std::prev(entry)->second.record_bytes > first)
		--entry;
	while (entry != bottom_.end() && entry->first < end)
	{
		discard(device, entry->second);
		entry = bottom_.erase(entry);
	}
}

void Structures::put(Device& device, VkAccelerationStructureKHR handle, TopLevel structure)
{
	const std::lock_guard guard(lock_);
	if (const auto found = top_.find(handle); found != top_.end())
		drop(device, found->second);
	top_[handle] = std::move(structure);
}

void Structures::copied(Device& device, VkAccelerationStructureKHR source, VkAccelerationStructureKHR destination)
{
	const std::lock_guard guard(lock_);
	const auto from = top_.find(source);
	if (from == top_.end() || source == destination)
		return;
	if (const auto to = top_.find(destination); to != top_.end())
		drop(device, to->second);
	// The copy's instances have the source's slots, which must outlive both: they are never given back.
	TopLevel copy = from->second;
	from->second.slot_count = 0;
	copy.slot_count = 0;
	top_[destination] = copy;
}

void Structures::destroyed(Device& device, VkAccelerationStructureKHR handle)
{
	const std::lock_guard guard(lock_);
	driver_addresses_.erase(handle);
	if (const auto found = top_.find(handle); found != top_.end())
	{
		drop(device, found->second);
		top_.erase(found);
	}
}

bool Structures::onlyClusters() const
{
	const std::lock_guard guard(lock_);
	return !top_.empty() && std::all_of(top_.begin(), top_.end(), [](const auto& entry) { return entry.second.has_clusters; });
}

void Structures::driverAddress(VkAccelerationStructureKHR handle, VkDeviceAddress address)
{
	const std::lock_guard guard(lock_);
	driver_addresses_[handle] = address;
}

bool Structures::isDriverAddress(VkDeviceAddress address) const
{
	const std::lock_guard guard(lock_);
	return std::any_of(driver_addresses_.begin(), driver_addresses_.end(), [&](const auto& entry) { return entry.second == address; });
}

void Structures::clear(Device& device)
{
	memoryEnded(device, 0, UINT64_MAX);
	const std::lock_guard guard(lock_);
	top_.clear();
}

VKAPI_ATTR void VKAPI_CALL destroyAccelerationStructure(VkDevice handle, VkAccelerationStructureKHR structure, const VkAllocationCallbacks* allocator)
{
	Device& device = deviceOf(handle);
	if (device.active && structure)
		device.structures.destroyed(device, structure);
	device.next.DestroyAccelerationStructureKHR(handle, structure, allocator);
}

VKAPI_ATTR VkDeviceAddress VKAPI_CALL getAccelerationStructureDeviceAddress(VkDevice handle, const VkAccelerationStructureDeviceAddressInfoKHR* info)
{
	Device& device = deviceOf(handle);
	const VkDeviceAddress address = device.next.GetAccelerationStructureDeviceAddressKHR(handle, info);
	if (device.active)
		device.structures.driverAddress(info->accelerationStructure, address);
	return address;
}

}  // namespace tessera::layer
