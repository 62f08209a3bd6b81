#include "frame/cluster_reserve.h"

#include <algorithm>

namespace tessera
{

namespace
{

constexpr uint64_t kStep = 1024;

uint64_t roundedUp(uint64_t count)
{
	return std::max<uint64_t>(1, (count + kStep - 1) / kStep) * kStep;
}

}  // namespace

uint32_t reservedAfter(uint32_t reserved, uint32_t wanted, uint32_t most)
{
	const bool is_small = uint64_t(wanted) * 16 > uint64_t(reserved) * 15, is_large = wanted < reserved / 2;
	const uint64_t next = wanted > 0 && (is_small || is_large) ? roundedUp(uint64_t(wanted) * 9 / 8) : reserved;
	return static_cast<uint32_t>(std::min<uint64_t>(next, most));
}

void ClusterReserve::follow(const ReserveCounts& least, const ReserveCounts& most)
{
	for (uint32_t kind = 0; kind < RESERVED_KINDS; ++kind)
	{
		const uint32_t before = reserved_[kind] > 0 ? reserved_[kind] : static_cast<uint32_t>(roundedUp(least[kind]));
		const uint32_t next = reservedAfter(before, wanted_[kind], most[kind]);
		if (next != reserved_[kind])
			peak_[kind] = peak_used_[kind] = 0;  // since it was made
		reserved_[kind] = next;
		wanted_[kind] = 0;
	}
}

bool ClusterReserve::isTooSmallFor(const ReserveCounts& wanted, bool fits)
{
	bool is_too_small = false;
	for (uint32_t kind = 0; kind < RESERVED_KINDS; ++kind)
	{
		wanted_[kind] = std::max(wanted_[kind], wanted[kind]);
		peak_[kind] = std::max(peak_[kind], wanted[kind]);
		is_too_small |= wanted[kind] > reserved_[kind];
	}
	for (uint32_t kind = 0; kind < RESERVED_KINDS && fits && !is_too_small; ++kind)
		peak_used_[kind] = std::max(peak_used_[kind], wanted[kind]);
	return is_too_small;
}

uint64_t ArrayPlaces::add(uint64_t count, uint64_t element_bytes)
{
	const uint64_t begin = bytes_;
	bytes_ = (bytes_ + count * element_bytes + 255) / 256 * 256;
	return begin;
}

}  // namespace tessera
