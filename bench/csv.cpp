#include "bench/csv.h"

#include "base/file.h"

#include <algorithm>

namespace tessera::bench
{

namespace
{

// The cells of one line, or nothing when a quote is left open or followed by something else.
std::optional<std::vector<std::string>> splitLine(std::string_view line)
{
	std::vector<std::string> cells(1);
	bool quoted = false;
	for (size_t i = 0; i < line.size(); ++i)
	{
		const char c = line[i];
		if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"')
			cells.back() += line[++i];
		else if (quoted && c == '"')
		{
			quoted = false;
			if (i + 1 < line.size() && line[i + 1] != ',')
				return std::nullopt;
		}
		else if (!quoted && c == '"' && cells.back().empty())
			quoted = true;
		else if (!quoted && c == ',')
			cells.emplace_back();
		else
			cells.back() += c;
	}
	if (quoted)
		return std::nullopt;
	return cells;
}

std::string cellText(std::string cell)
{
	std::replace_if(
		cell.begin(), cell.end(), [](unsigned char c) { return c < 0x20; }, ' ');
	if (cell.find_first_of(",\"#") == std::string::npos)
		return cell;
	std::string text = "\"";
	for (char c : cell)
	{
		if (c == '"')
			text += '"';
		text += c;
	}
	return text + '"';
}

std::string lineText(const std::vector<std::string>& cells)
{
	std::string text;
	for (size_t i = 0; i < cells.size(); ++i)
		text += (i ? "," : "") + cellText(cells[i]);
	return text + "\n";
}

}  // namespace

std::optional<size_t> CsvTable::find(std::string_view column) const
{
	const auto found = std::find(columns.begin(), columns.end(), column);
	if (found == columns.end())
		return std::nullopt;
	return static_cast<size_t>(found - columns.begin());
}

std::string_view CsvTable::at(size_t row, std::string_view column) const
{
	const std::optional<size_t> index = find(column);
	return index ? std::string_view(rows[row][*index]) : std::string_view();
}

Result<CsvTable> parseCsv(std::string_view text, std::string_view path)
{
	CsvTable table;
	for (size_t line_number = 1; !text.empty(); ++line_number)
	{
		const size_t end = std::min(text.find('\n'), text.size());
		std::string_view line = text.substr(0, end);
		text.remove_prefix(std::min(end + 1, text.size()));
		if (line.ends_with('\r'))
			line.remove_suffix(1);
		if (line.empty() || line.front() == '#')
			continue;
		std::optional<std::vector<std::string>> cells = splitLine(line);
		if (!cells)
			return badInput("{}:{}: a quote is open or stands inside a cell; \"a \"\"quoted\"\" cell\" is right", path, line_number);
		if (table.columns.empty())
			table.columns = std::move(*cells);
		else if (cells->size() != table.columns.size())
			return badInput("{}:{}: {} cells, the header names {}", path, line_number, cells->size(), table.columns.size());
		else
			table.rows.push_back(std::move(*cells));
	}
	if (table.columns.empty())
		return badInput("{}: is empty; a line with the names of the columns is right", path);
	return table;
}

Result<CsvTable> readCsv(const std::string& path)
{
	constexpr uint64_t kMostBytes = uint64_t(1) << 26;
	TRY_ASSIGN(const std::vector<std::byte> bytes, readFile(path, kMostBytes));
	return parseCsv({ reinterpret_cast<const char*>(bytes.data()), bytes.size() }, path);
}

std::string csvText(const CsvTable& table)
{
	std::string text = lineText(table.columns);
	for (const std::vector<std::string>& row : table.rows)
		text += lineText(row);
	return text;
}

}  // namespace tessera::bench
