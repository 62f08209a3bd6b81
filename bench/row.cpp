#include "bench/row.h"

#include <algorithm>

namespace tessera::bench
{

namespace
{

struct Column
{
	std::string_view name;
	std::string (*text)(const Row& row);
	bool of_every_row = false;  // failed rows have nothing to say in the others
};

std::string_view stateName(RowState state)
{
	switch (state)
	{
	case RowState::Measured:
		return "measured";
	case RowState::Coarsened:
		return "coarsened";
	case RowState::Failed:
		break;
	}
	return "failed";
}

std::string decimals(double value, int digits)
{
	return fmt::format("{:.{}f}", value, digits);
}

std::string count(uint64_t value)
{
	return fmt::format("{}", value);
}

const FrameCountsRead& countsOf(const Row& row)
{
	return row.frames.last.counts;
}

constexpr Column kColumns[] = {
	{ "series", [](const Row& row) { return row.what.series; }, true },
	{ "scene", [](const Row& row) { return row.what.scene; }, true },
	{ "copies", [](const Row& row) { return count(row.what.copies); }, true },
	{ "width", [](const Row& row) { return count(row.what.options.width_px); }, true },
	{ "height", [](const Row& row) { return count(row.what.options.height_px); }, true },
	{ "raster", [](const Row& row) { return row.what.raster; }, true },
	{ "cull", [](const Row& row) { return std::string(row.what.cull ? "on" : "off"); }, true },
	{ "rate", [](const Row& row) { return fmt::format("{}", row.what.options.rate); }, true },
	{ "peer_px", [](const Row& row) { return row.peer ? fmt::format("{}", row.peer->px) : std::string(); }, true },
	{ "state", [](const Row& row) { return std::string(stateName(row.state)); }, true },
	{ "error", [](const Row& row) { return row.error; }, true },
	{ "frames",
	  [](const Row& row) {
		  return count(row.frames.frame.gpu_ms.size());
	  } },
	{ "micro_mtri",
	  [](const Row& row) {
		  return decimals(double(countsOf(row).micro_triangles) * 1e-6, 6);
	  } },
	{ "part_triangles",
	  [](const Row& row) {
		  return count(countsOf(row).part_triangles);
	  } },
	{ "split_triangles",
	  [](const Row& row) {
		  return count(countsOf(row).split_triangles);
	  } },
	{ "full_clusters",
	  [](const Row& row) {
		  return count(countsOf(row).full_clusters);
	  } },
	{ "visible_clusters",
	  [](const Row& row) {
		  return count(countsOf(row).visible_clusters);
	  } },
	{ "covered_pixels",
	  [](const Row& row) {
		  return count(countsOf(row).covered_pixels);
	  } },
	{ "rate_granted",
	  [](const Row& row) {
		  return fmt::format("{:.6g}", row.frames.last.rate_granted);
	  } },
	{ "rounds",
	  [](const Row& row) {
		  return count(row.frames.last.rounds);
	  } },
	{ "gpu_ms_median",
	  [](const Row& row) {
		  return decimals(row.medianMs(), 6);
	  } },
	{ "gpu_ms_min",
	  [](const Row& row) {
		  return decimals(row.frames.frame.least(), 6);
	  } },
	{ "gpu_ms_max",
	  [](const Row& row) {
		  return decimals(row.frames.frame.most(), 6);
	  } },
	{ "peer_ms",
	  [](const Row& row) {
		  return row.peer ? fmt::format("{}", row.peer->gpu_ms) : std::string();
	  } },
	{ "peer_mtri",
	  [](const Row& row) {
		  return row.peer && row.peer->micro_mtri ? fmt::format("{}", *row.peer->micro_mtri) : std::string();
	  } },
	{ "peer_overflow",
	  [](const Row& row) {
		  return std::string(!row.peer ? "" : row.peer->overflow ? "yes" : "no");
	  } },
	{ "speed_up",
	  [](const Row& row) {
		  return row.speedUp() ? decimals(*row.speedUp(), 4) : std::string();
	  } },
	{ "lists_mib",
	  [](const Row& row) {
		  return decimals(toMib(row.memory.lists), 3);
	  } },
	{ "lists_used_mib",
	  [](const Row& row) {
		  return decimals(row.listsUsedMib(), 3);
	  } },
	{ "total_mib",
	  [](const Row& row) {
		  return decimals(toMib(row.memory.total()), 3);
	  } },
};

constexpr Column kUnitColumns[] = {
	{ "unit",
	  [](const Row& row) {
		  return std::string(unitOf(row.what.series));
	  } },
	{ "units",
	  [](const Row& row) {
		  return fmt::format("{:.0f}", unitCount(row));
	  } },
	{ "ns_per_unit",
	  [](const Row& row) {
		  return fmt::format("{:.6g}", row.ns_per_unit);
	  } },
	{ "ns_per_added_unit",
	  [](const Row& row) {
		  return row.ns_per_added_unit != 0 ? fmt::format("{:.6g}", row.ns_per_added_unit) : std::string();
	  } },
};

bool isSweep(std::span<const Row> rows)
{
	return !rows.empty() && rows.front().what.series != kTableSeries;
}

std::string passText(const Row& row, std::string_view pass)
{
	const auto found = row.frames.passes.find(std::string(pass));
	return found == row.frames.passes.end() ? "" : decimals(found->second.median(), 6);
}

}  // namespace

std::optional<double> Row::speedUp() const
{
	if (!peer || state != RowState::Measured || medianMs() <= 0)
		return std::nullopt;
	return peer->gpu_ms / medianMs();
}

double Row::listsUsedMib() const
{
	double bytes = 0;
	for (const ListStats& list : frames.last.lists)
		if (list.capacity > 0)
			bytes += double(list.bytes) * list.peak_used / list.capacity;
	return bytes / (1 << 20);
}

double toMib(uint64_t bytes)
{
	return double(bytes) / (1 << 20);
}

std::string_view unitOf(std::string_view series)
{
	return series == "triangles" || series == "rays" ? "micro-triangle"
		   : series == "base"                        ? "base triangle"
		   : series == "instances"                   ? "instance"
		   : series == "size"                        ? "pixel"
													 : "";
}

double unitCount(const Row& row)
{
	if (unitOf(row.what.series) == "micro-triangle")
		return double(countsOf(row).micro_triangles);
	if (row.what.series == "base")
		return double(row.what.base_triangles);
	if (row.what.series == "instances")
		return double(row.what.copies);
	return double(row.what.options.width_px) * row.what.options.height_px;
}

void addUnitCosts(std::vector<Row>& rows)
{
	for (size_t i = 0; i < rows.size(); ++i)
	{
		Row& row = rows[i];
		const double units = unitCount(row);
		if (row.state != RowState::Measured || units <= 0)
			continue;
		row.ns_per_unit = row.medianMs() * 1e6 / units;
		for (size_t j = i; j-- > 0;)
		{
			const Row& before = rows[j];
			const bool same = before.what.series == row.what.series && before.what.raster == row.what.raster && before.what.cull == row.what.cull;
			if (!same || before.state != RowState::Measured)
				continue;
			if (units > unitCount(before))
				row.ns_per_added_unit = (row.medianMs() - before.medianMs()) * 1e6 / (units - unitCount(before));
			break;
		}
	}
}

CsvTable rowsCsv(std::span<const Row> rows, std::span<const std::string_view> passes, std::string_view device)
{
	std::vector<Column> columns(std::begin(kColumns), std::end(kColumns));
	if (isSweep(rows))
		columns.insert(columns.end(), std::begin(kUnitColumns), std::end(kUnitColumns));
	CsvTable table;
	table.columns.emplace_back("device");
	for (const Column& column : columns)
		table.columns.emplace_back(column.name);
	for (std::string_view pass : passes)
		table.columns.push_back(fmt::format("pass_{}_ms", pass));
	for (const Row& row : rows)
	{
		std::vector<std::string>& cells = table.rows.emplace_back();
		cells.emplace_back(device);
		for (const Column& column : columns)
			cells.push_back(row.state == RowState::Failed && !column.of_every_row ? "" : column.text(row));
		for (std::string_view pass : passes)
			cells.push_back(passText(row, pass));
	}
	return table;
}

}  // namespace tessera::bench
