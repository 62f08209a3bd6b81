#include "layer/lookup_table.h"

#include "layer/device.h"

#include <algorithm>
#include <cstring>

namespace tessera::layer
{

uint32_t Ranges::take(uint32_t count)
{
	for (auto entry = free_.begin(); entry != free_.end(); ++entry)
		if (entry->second >= count)
		{
			const auto [first, had] = *entry;
			free_.erase(entry);
			if (had > count)
				free_[first + count] = had - count;
			return first;
		}
	end_ += count;
	return end_ - count;
}

void Ranges::give(uint32_t first, uint32_t count)
{
	if (count == 0)
		return;
	auto after = free_.upper_bound(first);
	if (after != free_.end() && after->first == first + count)
	{
		count += after->second;
		after = free_.erase(after);
	}
	if (after != free_.begin())
		if (const auto before = std::prev(after); before->first + before->second == first)
		{
			before->second += count;
			return;
		}
	free_[first] = count;
}

uint32_t DeviceTable::take(uint32_t count)
{
	const uint32_t first = ranges_.take(count);
	const size_t needed = size_t(ranges_.end()) * stride_;
	if (!buffers_.empty() && buffers_.back()->size() >= needed)
		return first;
	const auto grown = OwnBuffer::make(device_, std::max<size_t>(2 * needed, 1 << 16), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true);
	if (!grown)
		return UINT32_MAX;
	if (!buffers_.empty())
		std::memcpy(grown->data(), buffers_.back()->data(), buffers_.back()->size());
	buffers_.push_back(grown);
	const VkDeviceAddress address = grown->address();
	std::memcpy(root_, &address, sizeof(address));
	return first;
}

void DeviceTable::set(uint32_t index, const void* record)
{
	std::memcpy(buffers_.back()->data() + index * stride_, record, stride_);
}

LookupTable::LookupTable(Device& device)
	: root_(OwnBuffer::make(device, 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true)),
	  slots(device, sizeof(Slot), root_ ? root_->data() : nowhere_.data()), rows(device, sizeof(Row), root_ ? root_->data() + 8 : nowhere_.data()),
	  geometry_indices(device, sizeof(uint32_t), root_ ? root_->data() + 16 : nowhere_.data())
{
	// What a structure without clusters finds.
	const Slot slot;
	const Row row;
	const uint32_t index = 0;
	if (slots.take(1) == 0 && rows.take(1) == 0 && geometry_indices.take(1) == 0)
	{
		slots.set(0, &slot);
		rows.set(0, &row);
		geometry_indices.set(0, &index);
	}
	else
		device.report.limit("limit-memory", "no memory for the tables of clusters");
}

}  // namespace tessera::layer
