// The pictures of report.html, embedded.
#pragma once
#include "report/report_data.h"

namespace tessera::report
{

// A JSON array of { name, src, heat }: the runs of the first raster path of each size and rate, coarse to fine, and the references last. Pictures
// wider than 800 pixels are averaged down. Safe inside a <script> element. Errors: a picture cannot be read.
Result<std::string> picturesJson(const std::filesystem::path& folder, const ReportData& data);

// The section that kPageScript fills.
std::string picturesHtml();

}  // namespace tessera::report
