// The append lists of a frame: names (a promise of the stats), records, default capacities.
#pragma once
#include "base/result.h"
#include "plan/plan.h"
#include "shared/lists.h"

#include <array>

namespace tessera
{

struct ListDesc
{
	std::string_view name;
	uint32_t index;  // LIST_* in shared/lists.h
	uint32_t record_bytes;
	uint32_t default_capacity;  // upper bound of the default
	uint32_t least_capacity;    // smallest legal
};

std::span<const ListDesc> listDescs();
const ListDesc* findList(std::string_view name);

// Capacity of every list: --capacity, else the default, but no more than the scene can ever fill.
// Errors: Usage when a name is unknown or a value below the list's least.
Result<std::array<uint32_t, LIST_COUNT>> listCapacities(const PlanInput& input);

// Most entries that a list can hold: the payload's index has 24 bits, micro-vertices and triangles are counted in 28.
uint32_t mostEntries(const ListDesc& list);

// Packings of what other lists hold: they follow the demand and never decide the rate, unless memory runs out or
// --capacity fixes them.
bool growsOnDemand(const ListDesc& list);

// Bytes of a list's buffer at its capacity.
uint64_t listBytes(const ListDesc& list, uint32_t capacity);

}  // namespace tessera
