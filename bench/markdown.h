// The tables as a page to read.
#pragma once
#include "bench/compare.h"
#include "bench/row.h"

#include <map>

namespace tessera::bench
{

struct PageFacts
{
	std::string device;       // name and driver
	std::string peer_device;  // where the peer was measured; empty: nothing is compared with it
	std::string options;      // what every row was drawn with
	uint32_t frames = 0, warmup = 0;
	std::map<std::string, std::string> closed;  // raster paths that this device cannot do: why
	std::optional<Comparison> comparison;
};

// The table of kTableSeries with its summary against the peer.
std::string tablePage(std::span<const Row> rows, const PageFacts& facts);

// One table per sweep, with the cost of a unit. `rows` of all sweeps.
std::string scalingPage(std::span<const Row> rows, const PageFacts& facts);

}  // namespace tessera::bench
