// What the Limits panel tells of the lists: how full, how full they ever were, and capacities that would fit. Pure.
#pragma once
#include "frame/stats.h"

#include <map>
#include <span>
#include <string>

namespace tessera::view
{

enum class Fill : uint8_t
{
	Roomy,
	Tight,  // 80 % and more
	Full,   // above 100 %: the frame was coarsened, drawn in rounds, or again with a larger list
};

Fill fillOf(uint64_t wanted, uint64_t capacity);

// The most that was ever wanted of each list, over the session.
class HighWater
{
public:
	void add(std::span<const ListStats> lists);
	uint64_t of(const std::string& list) const;
	void clear() { most_.clear(); }

	// Capacities that hold the high-water marks with an eighth to spare: what "fit" sets. Lists of which nothing was wanted get their least.
	std::map<std::string, uint32_t> fittingCapacities() const;

private:
	std::map<std::string, uint64_t> most_;
};

// A line for the viewport while a frame is coarser than asked for; empty while it is not.
std::string coarseningWarning(const FrameResult& result);

}  // namespace tessera::view
