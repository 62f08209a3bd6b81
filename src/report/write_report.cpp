#include "base/file.h"
#include "base/log.h"
#include "report/report_charts.h"

#include <cstdlib>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace tessera::report
{

namespace
{

// The program of this name that the shell would find; empty when there is none.
std::filesystem::path programNamed(std::string_view name)
{
	const char* path = std::getenv("PATH");
	std::string_view rest = path ? path : "";
	while (!rest.empty())
	{
		const size_t end = std::min(rest.find(':'), rest.size());
		const std::filesystem::path program = std::filesystem::path(rest.substr(0, end)) / name;
		if (end > 0 && access(program.c_str(), X_OK) == 0)
			return program;
		rest.remove_prefix(std::min(end + 1, rest.size()));
	}
	return {};
}

bool runProgram(const std::vector<std::string>& arguments)
{
	std::vector<char*> words;
	for (const std::string& argument : arguments)
		words.push_back(const_cast<char*>(argument.c_str()));  // posix_spawn takes but does not change them
	words.push_back(nullptr);
	pid_t process = 0;
	int status = 0;
	return posix_spawn(&process, words[0], nullptr, nullptr, words.data(), environ) == 0 && waitpid(process, &status, 0) == process &&
		   WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

Status writeCharts(const std::filesystem::path& folder, const ReportData& data)
{
	std::vector<NamedChart> charts = timeCharts(data);
	for (const ErrorKind kind : kErrorKinds)
		for (NamedChart& chart : errorCharts(data, kind))
			charts.push_back(std::move(chart));
	for (NamedChart& chart : originalCharts(data))
		charts.push_back(std::move(chart));
	const std::filesystem::path converter = programNamed("rsvg-convert");
	for (const NamedChart& chart : charts)
	{
		const std::filesystem::path svg = folder / (chart.name + ".svg"), png = folder / (chart.name + ".png");
		TRY(writeFile(svg, std::string_view(standaloneSvg(chart.svg))));
		if (!converter.empty() && !runProgram({ converter.string(), "--zoom", "2", "-o", png.string(), svg.string() }))
			logWarning("{}: rsvg-convert made no PNG of it", svg.string());
	}
	if (converter.empty())
		logInfo("rsvg-convert is not installed: plots are written as SVG only");
	return {};
}

}  // namespace

Status writeReport(const std::filesystem::path& folder, const ReportData& data)
{
	TRY_ASSIGN(const std::string html, reportHtml(folder, data));
	TRY(writeCharts(folder / "plots", data));
	TRY(writeFile(folder / "report.csv", std::string_view(reportCsv(data))));
	TRY(writeFile(folder / "report.json", std::string_view(reportJson(data).dump(1, '\t', false, nlohmann::json::error_handler_t::replace) + "\n")));
	return writeFile(folder / "report.html", std::string_view(html));
}

}  // namespace tessera::report
