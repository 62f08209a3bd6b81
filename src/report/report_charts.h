// The charts of a report.
#pragma once
#include "report/chart.h"
#include "report/report_data.h"

namespace tessera::report
{

struct NamedChart
{
	std::string name;  // of its file, without the ending
	std::string svg;
};

// Error against time, against rate, and against triangles, by one kind of error.
std::vector<NamedChart> errorCharts(const ReportData& data, ErrorKind kind);

// Error against the original over micro-triangles and over time, root mean square and 99th percentile, between the floor and what it is without
// displacement. None without an original.
std::vector<NamedChart> originalCharts(const ReportData& data);

// Time against rate, and time per pass.
std::vector<NamedChart> timeCharts(const ReportData& data);

}  // namespace tessera::report
