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

// Capacity of every list: --capacity, else a share of --budget or the default, but no more than the scene can ever fill.
// Errors: Usage when a name is unknown, a value below the list's least, or the budget too small for the least of all lists.
Result<std::array<uint32_t, LIST_COUNT>> listCapacities(const PlanInput& input);

// Most entries that a list can hold: the payload's index has 24 bits, micro-vertices and triangles are counted in 28.
uint32_t mostEntries(const ListDesc& list);

// Packings of what other lists hold: they follow the demand and never decide the rate, unless memory runs out or an
// option fixes them.
bool growsOnDemand(const ListDesc& list);
// --capacity or --budget says how many entries a list has, so it does not grow.
bool isFixed(const ListDesc& list, const RenderOptions& options);

// Bytes of all lists that frames with these options can need, at these capacities, with their heads, counts and places.
uint64_t bytesOfLists(const std::array<uint32_t, LIST_COUNT>& capacities, const PlanInput& input);

// Bytes of a list's buffer at its capacity.
uint64_t listBytes(const ListDesc& list, uint32_t capacity);
// Of the buffer that holds it: micro_vertices has one entry more, that of triangles that are not there.
uint64_t listBufferBytes(const ListDesc& list, uint32_t capacity);

}  // namespace tessera
