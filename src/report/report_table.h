// The columns of a report's table: the same for the page and the CSV file.
#pragma once
#include "report/report_data.h"

#include <span>

namespace tessera::report
{

struct Column
{
	std::string_view key;   // in the CSV
	std::string_view head;  // on the page; empty: in the CSV only
	std::string_view hint;
	std::string (*cell)(const Run& run);             // empty: not measured
	std::string (*shown)(const Run& run) = nullptr;  // on the page, when it differs
};

std::span<const Column> reportColumns();
// Those that the page shows: columns of the original only where there is one.
std::vector<const Column*> pageColumns(const ReportData& data);

}  // namespace tessera::report
