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

// Time against rate, and time per pass.
std::vector<NamedChart> timeCharts(const ReportData& data);

}  // namespace tessera::report
