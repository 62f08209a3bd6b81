#include "bench/compare.h"

#include "app/option_text.h"

#include <map>

namespace tessera::bench
{

namespace
{

constexpr std::string_view kKeyColumns[] = { "series", "scene", "copies", "width", "height", "raster", "cull", "rate" };

std::string keyOf(const CsvTable& table, size_t row)
{
	std::string key;
	for (std::string_view column : kKeyColumns)
		key += fmt::format("{}|", table.at(row, column));
	return key;
}

std::string nameOf(const CsvTable& table, size_t row)
{
	const auto at = [&](std::string_view column) {
		return table.at(row, column);
	};
	return fmt::format("{} x{} {}x{} {} cull {} rate {}", at("scene"), at("copies"), at("width"), at("height"), at("raster"), at("cull"), at("rate"));
}

using Times = std::map<std::string, double>;

Result<Times> measuredTimes(const CsvTable& table, std::string_view path)
{
	for (std::string_view column : kKeyColumns)
		if (!table.find(column))
			return badInput("{}: there is no column {}; a table that tessera_bench wrote is right", path, column);
	Times times;
	for (size_t row = 0; row < table.rows.size(); ++row)
	{
		if (table.at(row, "state") != "measured")
			continue;
		const std::optional<double> ms = readNumber(table.at(row, "gpu_ms_median"));
		if (!ms || *ms <= 0)
			return badInput("{}: row {}, gpu_ms_median: '{}' is not a number above 0", path, row + 1, table.at(row, "gpu_ms_median"));
		times[keyOf(table, row)] = *ms;
	}
	return times;
}

}  // namespace

Result<Comparison> compareTables(const CsvTable& now, const CsvTable& stored, std::string_view path)
{
	TRY_ASSIGN(Times before, measuredTimes(stored, path));
	TRY_ASSIGN(const Times times, measuredTimes(now, "this run"));
	Comparison comparison;
	if (!stored.rows.empty() && !now.rows.empty() && stored.at(0, "device") != now.at(0, "device"))
		comparison.stored_device = stored.at(0, "device");
	for (size_t row = 0; row < now.rows.size(); ++row)
	{
		const auto time = times.find(keyOf(now, row));
		if (time == times.end())
			continue;
		const auto found = before.find(time->first);
		if (found == before.end())
		{
			++comparison.unmatched;
			continue;
		}
		comparison.rows.push_back({ nameOf(now, row), time->second, found->second });
		before.erase(found);
	}
	comparison.unmatched += before.size();
	return comparison;
}

}  // namespace tessera::bench
