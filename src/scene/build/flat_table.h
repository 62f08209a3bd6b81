// A flat hash table from keys that the caller keeps to 32-bit numbers: open addressing, no allocation per entry.
#pragma once
#include <bit>
#include <cstdint>
#include <vector>

namespace tessera
{

// Spreads the bits of a key (the finisher of MurmurHash3).
inline uint64_t mixBits(uint64_t key)
{
	key ^= key >> 33;
	key *= 0xff51afd7ed558ccdull;
	key ^= key >> 33;
	key *= 0xc4ceb9fe1a85ec53ull;
	return key ^ (key >> 33);
}

// Numbers < 2^32 - 1, found again by the caller's idea of equality.
class FlatTable
{
public:
	// `most`: largest number of entries that will be put in.
	explicit FlatTable(size_t most) : slots_(std::bit_ceil(most * 2 + 2), kEmpty), mask_(slots_.size() - 1) {}

	// Returns the entry for which same(entry) is true; where there is none, puts `number` in and returns it.
	// `hash` has to be equal for entries that are the same.
	template <typename Same>
	uint32_t findOrInsert(uint64_t hash, uint32_t number, Same&& same)
	{
		for (size_t slot = hash & mask_;; slot = (slot + 1) & mask_)
		{
			if (slots_[slot] == kEmpty)
				return slots_[slot] = number;
			if (same(slots_[slot]))
				return slots_[slot];
		}
	}

private:
	static constexpr uint32_t kEmpty = 0xffffffffu;
	std::vector<uint32_t> slots_;
	size_t mask_;
};

}  // namespace tessera
