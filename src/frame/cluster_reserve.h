// How much of everything rays' clusters are reserved: a build on the device takes its maxima from the host, which knows the last frame's. Pure.
#pragma once
#include "raytracing/cluster_lists.h"

#include <array>

namespace tessera
{

using ReserveCounts = std::array<uint32_t, RESERVED_KINDS>;

// A reservation for the next frame when `wanted` were wanted since it was made (0: nothing drawn since): an eighth more when it is nearly full, so
// that a moving camera seldom draws a frame twice; less than half full, it shrinks. Multiples of 1024, at most `most`.
uint32_t reservedAfter(uint32_t reserved, uint32_t wanted, uint32_t most);

class ClusterReserve
{
public:
	// For the next frame. `least`: what is reserved before any frame was drawn.
	void follow(const ReserveCounts& least, const ReserveCounts& most);
	// A round of a frame wanted this much; `fits`: its lists held it, so it was built if this reservation held it as well. True when that was too
	// small.
	bool isTooSmallFor(const ReserveCounts& wanted, bool fits);
	// Nothing is known any more.
	void forget() { *this = {}; }

	const ReserveCounts& reserved() const { return reserved_; }
	const ReserveCounts& peak() const { return peak_; }
	const ReserveCounts& peakUsed() const { return peak_used_; }

private:
	ReserveCounts reserved_ = {}, wanted_ = {}, peak_ = {}, peak_used_ = {};
};

// Where arrays lie in one buffer, side by side, each on a 256-byte boundary.
class ArrayPlaces
{
public:
	// Adds an array; gives where it begins.
	uint64_t add(uint64_t count, uint64_t element_bytes);
	uint64_t bytes() const { return bytes_; }

private:
	uint64_t bytes_ = 0;
};

}  // namespace tessera
