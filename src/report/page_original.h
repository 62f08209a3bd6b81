// What a report says of distances to the original (--original).
#pragma once
#include "report/report_data.h"

namespace tessera::report
{

// Measured against an original.
bool hasOriginal(const Run& run);

// In words, a sentence or two per picture size and metric: from where to where the error falls, how near to the floor that is, and whether the
// height maps bring the surface nearer at all. Empty without an original.
std::vector<std::string> describeOriginal(const ReportData& data);

// The section of the page; empty without an original.
std::string originalHtml(const ReportData& data);

}  // namespace tessera::report
