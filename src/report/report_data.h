// Everything that a report says, and the files that it is written as.
#pragma once
#include "report/recommend.h"

#include <filesystem>
#include <map>

namespace tessera::report
{

// Something that the scene, the options or the device do not need.
struct LeftOut
{
	std::string kind;  // "pass", "shader feature", "buffer", ...
	std::string name, reason;
	uint64_t bytes = 0;  // not allocated; 0 for passes and features
	// GPU time of a frame with it forced on, less that without it, each a median; `noise_ms`: two standard errors of that.
	std::optional<double> saved_ms;
	double noise_ms = 0;
	std::string not_measured;   // why there is no time
	std::string measured_with;  // the same measurement stands for all that is kept under one condition: by what that was forced
};

// The model of --original.
struct OriginalFacts
{
	std::string path;
	uint64_t triangles = 0;  // over its instances
};

struct ReportData
{
	std::string scene;    // as the user named it
	std::string command;  // that makes this report again
	std::string version;  // of the program
	std::string device, driver, api;
	nlohmann::json facts;                                          // scene, options and device, as in runs.jsonl
	std::vector<std::pair<std::string, std::string>> scene_facts;  // name and value
	std::vector<Run> runs;
	std::map<std::string, std::string> closed;  // raster paths that the device cannot do, and why
	std::vector<LeftOut> left_out;
	uint64_t bytes_kept = 0, bytes_saved = 0;  // by leaving out
	std::optional<OriginalFacts> original;
	Limits limits;
};

// Writes report.html, report.json, report.csv and plots/*.svg into `folder`; plots/*.png too when rsvg-convert is found. Pictures are read from
// `folder`. Errors: those of files.
Status writeReport(const std::filesystem::path& folder, const ReportData& data);

// A row per run; the first has the names. Empty cells where nothing was measured.
std::string reportCsv(const ReportData& data);
nlohmann::json reportJson(const ReportData& data);
// The whole page; embeds the pictures of `folder`. Needs no network. Errors: those of reading the pictures.
Result<std::string> reportHtml(const std::filesystem::path& folder, const ReportData& data);

}  // namespace tessera::report
