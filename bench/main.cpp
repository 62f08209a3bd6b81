// tessera_bench: measures, compares, and writes the tables after every row, so that a run that is cut short leaves its rows.
#include "app/option_text.h"
#include "base/file.h"
#include "base/log.h"
#include "bench/measure.h"
#include "pipeline/passes.h"

#include <algorithm>
#include <cstdio>

namespace tessera::bench
{

namespace
{

namespace fs = std::filesystem;

// What every row was drawn with besides what its columns say, as the command line would give it.
std::string sharedOptions(const AppOptions& options)
{
	std::string text;
	const AppOptions plain;
	for (const OptionDesc& option : optionTable())
	{
		if (option.name == "frames" || option.name == "warmup" || option.name == "device" || option.name == "quiet")
			continue;
		const std::vector<std::string> values = printOption(option, options);
		if (values == printOption(option, plain))
			continue;
		for (const std::string& value : values)
			text += fmt::format("{}--{}{}{}", text.empty() ? "" : " ", option.name, value.empty() ? "" : " ", value);
	}
	return text;
}

class Writer
{
public:
	Writer(const Settings& settings, std::optional<CsvTable> stored) : settings_(settings), stored_(std::move(stored)) {}

	Status write(const Measurements& done)
	{
		PageFacts facts = { done.device, done.peer_device, sharedOptions(settings_.base), settings_.base.frames, settings_.base.warmup, done.closed,
							{} };
		std::vector<Row> rows = done.rows;
		if (settings_.scaling.empty())
		{
			TRY(writeSeries(rows, "bench.csv", facts));
			return writeFile(fs::path(settings_.out) / "bench.md", std::string_view(tablePage(rows, facts)));
		}
		std::stable_sort(rows.begin(), rows.end(),
						 [](const Row& a, const Row& b) { return std::pair(a.what.raster, a.what.cull) < std::pair(b.what.raster, b.what.cull); });
		addUnitCosts(rows);
		for (const std::string& series : settings_.scaling)
		{
			std::vector<Row> own;
			for (const Row& row : rows)
				if (row.what.series == series)
					own.push_back(row);
			if (!own.empty())
				TRY(writeSeries(own, fmt::format("scaling_{}.csv", series), facts));
		}
		return writeFile(fs::path(settings_.out) / "scaling.md", std::string_view(scalingPage(rows, facts)));
	}

	// Of the last write.
	const std::optional<Comparison>& comparison() const { return comparison_; }

private:
	// One table; a stored table is compared with the one that has rows in common with it.
	Status writeSeries(std::span<const Row> rows, const std::string& name, PageFacts& facts)
	{
		std::vector<std::string_view> passes;
		for (const PassDesc* pass : framePasses())
			passes.push_back(pass->name);
		const CsvTable csv = rowsCsv(rows, passes, facts.device);
		TRY(writeFile(fs::path(settings_.out) / name, std::string_view(csvText(csv))));
		if (!stored_)
			return {};
		TRY_ASSIGN(Comparison comparison, compareTables(csv, *stored_, settings_.compare));
		if (facts.comparison && comparison.rows.empty())
			return {};
		comparison_ = facts.comparison = std::move(comparison);
		return {};
	}

	const Settings& settings_;
	std::optional<CsvTable> stored_;
	std::optional<Comparison> comparison_;
};

void printComparison(const Comparison& comparison, const std::string& path)
{
	if (!comparison.stored_device.empty())
		fmt::print(stderr, "warning: {} is of another device: {}\n", path, comparison.stored_device);
	size_t slower = 0;
	for (const ComparedRow& row : comparison.rows)
	{
		slower += row.isSlower();
		fmt::print("{}: {:.3f} ms, stored {:.3f} ms, ratio {:.3f}{}\n", row.name, row.now_ms, row.stored_ms, row.ratio(),
				   row.isSlower() ? " SLOWER" : "");
	}
	fmt::print("{} rows compared with {}, {} more than 10 % slower, {} in one table only\n", comparison.rows.size(), path, slower,
			   comparison.unmatched);
}

Status summarize(const Settings& settings, const Writer& writer, const Bench& bench)
{
	if (writer.comparison())
		printComparison(*writer.comparison(), settings.compare);
	size_t measured = 0, failed = 0;
	for (const Row& row : bench.measurements().rows)
	{
		measured += row.state == RowState::Measured;
		failed += row.state == RowState::Failed;
	}
	if (!settings.base.quiet)
		fmt::print(stderr, "{} measured, {} coarsened, {} failed; tables are in {}\n", counted(measured, "row"),
				   bench.measurements().rows.size() - measured - failed, failed, settings.out);
	if (const uint32_t count = bench.validationMessages())
		return fail(ExitCode::CheckFailed, "--validate: the validation layer had {}", counted(count, "message"));
	if (measured == 0)
		return fail(ExitCode::DeviceCannot, "no row could be measured");
	return {};
}

Status runBench(const std::vector<std::string>& arguments)
{
	TRY_ASSIGN(const Settings settings, parseSettings(arguments));
	if (!settings.help.empty())
	{
		fmt::print("{}", settings.help);
		return {};
	}
	setLogLevel(LogLevel::Quiet);
	std::optional<CsvTable> stored;
	if (!settings.compare.empty())
	{
		TRY_ASSIGN(stored, readCsv(settings.compare));
	}
	TRY_ASSIGN(const std::vector<Case> cases, settings.scaling.empty() ? tableCases(settings) : Result<std::vector<Case>>(scalingCases(settings)));
	TRY_ASSIGN(const std::unique_ptr<Bench> bench, Bench::create(settings));
	if (!settings.base.quiet)
		fmt::print(stderr, "device {}\n", bench->measurements().device);
	Writer writer(settings, std::move(stored));
	TRY(bench->run(cases, [&](const Measurements& done) { return writer.write(done); }));
	return summarize(settings, writer, *bench);
}

}  // namespace

}  // namespace tessera::bench

int main(int argc, char** argv)
{
	const tessera::Status status = tessera::bench::runBench({ argv + (argc > 0 ? 1 : 0), argv + argc });
	if (status)
		return static_cast<int>(tessera::ExitCode::Fine);
	fmt::print(stderr, "tessera_bench: error: {}\n", status.error().message);
	return static_cast<int>(status.error().code);
}
