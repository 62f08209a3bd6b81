// This run against the table of an earlier one.
#pragma once
#include "bench/csv.h"

namespace tessera::bench
{

inline constexpr double kSlowerRatio = 1.10;  // above: the row is marked

struct ComparedRow
{
	std::string name;
	double now_ms = 0, stored_ms = 0;

	double ratio() const { return now_ms / stored_ms; }
	bool isSlower() const { return ratio() > kSlowerRatio; }
};

struct Comparison
{
	std::vector<ComparedRow> rows;  // those that both tables measured, in the order of this run
	size_t unmatched = 0;           // rows of this run that the stored table did not measure, or the other way round
	std::string stored_device;      // empty when it is that of this run
};

// Rows are the same when series, scene, copies, size, raster path, culling and rate are. Coarsened and failed rows do not count.
// Errors: BadInput with `path` when `stored` lacks one of those columns or a time is not a number above 0.
Result<Comparison> compareTables(const CsvTable& now, const CsvTable& stored, std::string_view path);

}  // namespace tessera::bench
