// Tables as text: comma-separated values with a header line.
#pragma once
#include "base/result.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::bench
{

struct CsvTable
{
	std::vector<std::string> columns;
	std::vector<std::vector<std::string>> rows;  // each as long as `columns`

	// Index of a column by its name.
	std::optional<size_t> find(std::string_view column) const;
	// Text of one cell; empty when there is no such column.
	std::string_view at(size_t row, std::string_view column) const;
};

// Lines that start with '#' and empty lines are left out; cells may be quoted, but end with their line.
// `path` is for messages. Errors: BadInput with path and line (no header, a row of another length, an open quote).
Result<CsvTable> parseCsv(std::string_view text, std::string_view path);

Result<CsvTable> readCsv(const std::string& path);

// Quotes what needs it; control characters in cells become blanks, so that a row is a line.
std::string csvText(const CsvTable& table);

}  // namespace tessera::bench
