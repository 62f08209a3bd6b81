// Appending to lists: one atomic per workgroup and list.
#ifndef TESSERA_LIB_LISTS
#define TESSERA_LIB_LISTS
#include "shared/lists.h"

// Reserves `count` entries and returns the first. `wanted` keeps counting past capacity (saturating at 2^31, far above any
// capacity); the caller writes only below capacity. Where entries are drawn, the rows of the indirect draw keep up with them.
uint reserveEntries(ListHeadRef heads, uint list, uint count)
{
	if (heads.at[list].wanted >= 0x80000000u)
		return 0x80000000u;
	uint first = atomicAdd(heads.at[list].wanted, count);
	if (KEEPS_VERTICES)
	{
		uint width = heads.at[list].group_width;
		uint end = min(first + count, heads.at[list].capacity);
		uint rows = (end + width - 1u) / width;
		if (rows > (first + width - 1u) / width)
			atomicMax(heads.at[list].group_rows, rows);
	}
	return first;
}

// Entries that were written.
uint entriesOf(ListHeadRef heads, uint list) { return min(heads.at[list].wanted, heads.at[list].capacity); }

// A 64-bit count in two words, without 64-bit atomics.
void addMicroTriangles(FrameCountsRef counts, uint count)
{
	uint before = atomicAdd(counts.at[0].micro_low, count);
	if (before + count < before)
		atomicAdd(counts.at[0].micro_high, 1u);
}

#endif
