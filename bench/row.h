// One measured case and the tables it goes into.
#pragma once
#include "app/stats_json.h"
#include "bench/cases.h"
#include "bench/peer.h"

namespace tessera::bench
{

enum class RowState : uint8_t
{
	Measured,
	Coarsened,  // a list would have overflowed: less was drawn than asked for, so the time does not count
	Failed,     // see error
};

struct Row
{
	Case what;
	RowState state = RowState::Failed;
	std::string error;   // one line
	FrameSeries frames;  // empty when failed
	MemoryStats memory;
	std::optional<PeerTime> peer;  // at equal work
	// Of sweeps only, filled in by addUnitCosts.
	double ns_per_unit = 0;
	double ns_per_added_unit = 0;  // against the row before of the same raster path and culling; 0: there is none

	double medianMs() const { return frames.frame.median(); }
	std::optional<double> speedUp() const;  // the peer's time over ours; only measured rows have one
	double listsUsedMib() const;            // what the drawn frames filled at most
};

double toMib(uint64_t bytes);

// What a sweep counts: "micro-triangle", "base triangle", "instance" or "pixel"; empty for the table.
std::string_view unitOf(std::string_view series);
double unitCount(const Row& row);
void addUnitCosts(std::vector<Row>& rows);

// Every row with all that was measured, and a column pass_NAME_ms with the median of each of `passes`: empty where it did not run.
// `device`: name and driver. Sweeps have unit columns more.
CsvTable rowsCsv(std::span<const Row> rows, std::span<const std::string_view> passes, std::string_view device);

}  // namespace tessera::bench
