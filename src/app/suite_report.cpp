#include "app/suite_report.h"

#include "app/option_text.h"
#include "app/stats_json.h"

#include <cmath>

namespace tessera
{

using nlohmann::ordered_json;
using verify::SuiteLine;

namespace
{

std::string shortNumber(double value)
{
	return value == 0 ? "0" : fmt::format("{:.2g}", value);
}

std::string row(const SuiteLine& line, bool usual_way)
{
	std::string text = fmt::format("{:<14}{:<30}", line.family, line.name);
	if (!line.skipped.empty())
		return text + "skipped: " + line.skipped + "\n";
	text += fmt::format("{:>7}{:>11}{:>10}{:>10}  {:<7}{:>9}{:>9}{:>8.2f}", line.checks, line.violations, shortNumber(line.worst),
						shortNumber(line.bound), line.passed ? "yes" : "NO", shortNumber(line.error_ulp), shortNumber(line.error_px), line.seconds);
	if (usual_way)
		text += fmt::format("{:>9}{:>12}", line.usual_way.own_sides, line.usual_way.lost);
	return text + "\n";
}

std::string remarks(const verify::SuiteReport& report)
{
	std::string text;
	for (const SuiteLine& line : report.lines)
		if (line.skipped.empty() && !line.passed)
			text += fmt::format("FAILED {}: {}; expected: {}\n", line.name, line.wrong, line.expected);
	return text;
}

// Numbers that JSON cannot say become text.
ordered_json number(double value)
{
	return std::isfinite(value) ? ordered_json(value) : ordered_json(fmt::format("{}", value));
}

ordered_json lineJson(const SuiteLine& line)
{
	ordered_json json = { { "family", line.family }, { "case", line.name }, { "what", line.what } };
	if (!line.skipped.empty())
	{
		json["skipped"] = line.skipped;
		return json;
	}
	json["expected"] = line.expected;
	json["checks"] = line.checks;
	json["violations"] = line.violations;
	json["measure"] = line.measure;
	json["worst"] = number(line.worst);
	json["bound"] = number(line.bound);
	json["passed"] = line.passed;
	json["wrong"] = line.wrong;
	json["error_ulp"] = number(line.error_ulp);
	json["error_px"] = number(line.error_px);
	json["seconds"] = line.seconds;
	if (line.usual_way.points > 0)
		json["usual_way"] = { { "cracks", line.usual_way.own_sides },
							  { "largest_gap_mesh_units", number(line.usual_way.own_sides_gap) },
							  { "lost_triangles", line.usual_way.lost } };
	return json;
}

}  // namespace

std::string suiteTable(const verify::SuiteReport& report, const Device& device, bool usual_way)
{
	std::string text = fmt::format("suite {} on {}\n\n{:<14}{:<30}{:>7}{:>11}{:>10}{:>10}  {:<7}{:>9}{:>9}{:>8}", report.suite, device.name, "family",
								   "case", "checks", "violations", "worst", "bound", "passed", "ulp", "px", "s");
	text += usual_way ? fmt::format("{:>9}{:>12}\n", "cracks", "lost") : "\n";
	for (const SuiteLine& line : report.lines)
		text += row(line, usual_way);
	text += fmt::format("\n{} of {} passed, {} failed, {} skipped\n", report.lines.size() - report.failed() - report.skipped(),
						counted(report.lines.size(), "case"), report.failed(), report.skipped());
	return text + remarks(report);
}

ordered_json suiteJson(const verify::SuiteReport& report, const Device& device, uint64_t seed)
{
	ordered_json json = { { "schema", 1 }, { "suite", report.suite }, { "device", deviceJson(device) }, { "seed", seed } };
	json["failed"] = report.failed();
	json["skipped"] = report.skipped();
	json["cases"] = ordered_json::array();
	for (const SuiteLine& line : report.lines)
		json["cases"].push_back(lineJson(line));
	return json;
}

}  // namespace tessera
