// The bench without a device: its command line, its cases, the peer's data files, tables and comparisons.
#include "bench/cases.h"
#include "bench/markdown.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

namespace tessera::bench::test
{

namespace
{

Settings settingsOf(const std::vector<std::string>& arguments)
{
	const Result<Settings> settings = parseSettings(arguments);
	EXPECT_TRUE(settings) << (settings ? "" : settings.error().message);
	return settings ? *settings : Settings();
}

std::string refusal(const std::vector<std::string>& arguments)
{
	const Result<Settings> settings = parseSettings(arguments);
	if (settings)
		return "accepted";
	EXPECT_EQ(settings.error().code, ExitCode::Usage);
	return settings.error().message;
}

std::vector<Case> tableOf(const std::vector<std::string>& arguments)
{
	const Result<std::vector<Case>> cases = tableCases(settingsOf(arguments));
	EXPECT_TRUE(cases);
	return cases ? *cases : std::vector<Case>();
}

// A row of sphere x1 as if its frames had taken these times.
Row rowOf(const std::vector<double>& frames_ms, float rate = 0.866f)
{
	Row row;
	row.what = tableOf({ "--scene", "sphere-x1", "--raster", "mesh", "--cull", "off", "--sizes", "1920x1080" }).at(0);
	row.what.options.rate = rate;
	row.state = RowState::Measured;
	for (const double ms : frames_ms)
	{
		FrameResult frame;
		frame.gpu_ms = ms;
		frame.rate_wanted = frame.rate_granted = double(rate);
		frame.counts.micro_triangles = 6'809'000;
		frame.passes = { { "shade", ms / 4 } };
		row.frames.add(frame);
	}
	return row;
}

constexpr std::string_view kPasses[] = { "shade", "trace" };

CsvTable csvOf(const std::vector<Row>& rows)
{
	return rowsCsv(rows, kPasses, "device, driver 1");
}

PeerTable peerFile(const std::string& name)
{
	const std::string path = std::string(TESSERA_BENCH_DATA) + "/" + name;
	const Result<CsvTable> csv = readCsv(path);
	EXPECT_TRUE(csv) << (csv ? "" : csv.error().message);
	const Result<PeerTable> table = csv ? peerTable(*csv, path) : PeerTable();
	EXPECT_TRUE(table) << (table ? "" : table.error().message);
	return table ? *table : PeerTable();
}

TEST(benchCsv, whatIsWrittenReadsBackTheSame)
{
	const CsvTable table = { { "name", "text" }, { { "a", "plain" }, { "b", "with, comma" }, { "c", "a \"quoted\" word" }, { "# d", "" } } };
	const Result<CsvTable> again = parseCsv(csvText(table), "test.csv");
	ASSERT_TRUE(again) << again.error().message;
	EXPECT_EQ(again->columns, table.columns);
	EXPECT_EQ(again->rows, table.rows);
}

TEST(benchCsv, refusesWithPathAndLine)
{
	EXPECT_EQ(parseCsv("a,b\n1,2\n3\n", "t.csv").error().message, "t.csv:3: 1 cells, the header names 2");
	EXPECT_NE(parseCsv("a\n\"open\n", "t.csv").error().message.find("t.csv:2: a quote is open"), std::string::npos);
	EXPECT_NE(parseCsv("# nothing\n\n", "t.csv").error().message.find("is empty"), std::string::npos);
}

TEST(benchPeer, filesReadAndMarkOverflows)
{
	const PeerTable table = peerFile("peer_h100.csv");
	EXPECT_EQ(table.times.size(), 28u);
	const PeerTime* overflowed = table.find("sphere x16", 3840, 2160, 0.5);
	ASSERT_TRUE(overflowed);
	EXPECT_TRUE(overflowed->overflow);
	EXPECT_EQ(overflowed->gpu_ms, 179.3);
	const PeerTime* fine = table.find("terrain x1", 1920, 1080, 1);
	ASSERT_TRUE(fine);
	EXPECT_FALSE(fine->overflow);
	EXPECT_EQ(fine->micro_mtri, 2.910);
	EXPECT_FALSE(table.find("terrain x1", 1920, 1080, 8));
	EXPECT_EQ(peerFile("peer_lavapipe.csv").times.size(), 4u);
}

TEST(benchPeer, refusesWhatIsNotATime)
{
	const std::string header = "device,scene,width,height,px,gpu_ms,micro_mtri,overflow\n";
	const auto messageOf = [&](const std::string& text) {
		const Result<PeerTable> table = peerTable(*parseCsv(text, "p.csv"), "p.csv");
		return table ? "accepted" : table.error().message;
	};
	EXPECT_EQ(messageOf(header + "d,sphere x1,1920,1080,8,fast,1,no\n"), "p.csv: row 1, gpu_ms: 'fast' is not a number above 0");
	EXPECT_EQ(messageOf(header + "d,sphere x1,1920,1080,8,1,1,maybe\n"), "p.csv: row 1, overflow: 'maybe'; yes or no is right");
	EXPECT_NE(messageOf("device,scene\nd,s\n").find("there is no column width"), std::string::npos);
}

TEST(benchPeer, equalWorkLeavesTheFieldOfViewOut)
{
	const std::vector<double> rates = { 6.93, 3.46, 1.73, 0.866, 0.433 }, pixels = { 8, 4, 2, 1, 0.5 };
	for (size_t i = 0; i < rates.size(); ++i)
		EXPECT_EQ(peerPixels(rates[i]), pixels[i]);
	EXPECT_FALSE(peerPixels(4));
	EXPECT_FALSE(peerPixels(1));
}

TEST(benchCases, theWholeTableHasEveryScenePathSizeAndRateOnce)
{
	const std::vector<Case> cases = tableOf({});
	const size_t rasters = settingsOf({}).rasters.size();
	EXPECT_EQ(cases.size(), 4 * rasters * 2 * 2 * 5);
	std::set<std::string> labels;
	for (const Case& one : cases)
		labels.insert(one.label());
	EXPECT_EQ(labels.size(), cases.size());
	for (const Case& one : cases)
		EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(TESSERA_BENCH_DATA) / "scenes" / one.path)) << one.path;
}

TEST(benchCases, copiesStandWhereThePeerHadThem)
{
	const std::vector<Case> cases = tableOf({ "--scene", "terrain-x16" });
	ASSERT_FALSE(cases.empty());
	const AppOptions& options = cases[0].options;
	EXPECT_EQ(cases[0].sceneLabel(), "terrain x16");
	EXPECT_EQ(options.grid_columns * options.grid_rows, 16u);
	EXPECT_EQ(options.grid_u, dvec3(-10, 0, 0));
	EXPECT_EQ(options.grid_v, dvec3(0, 0, -10));
	EXPECT_EQ(options.eye, dvec3(-15, 18.4, 21));
	EXPECT_EQ(options.fov_deg, 60);
}

TEST(benchCases, sweepsGrowTheirUnit)
{
	const std::vector<Case> cases = scalingCases(settingsOf({ "--scaling", "--raster", "mesh", "--cull", "off" }));
	std::map<std::string, size_t> counts;
	const Case* before = nullptr;
	for (const Case& one : cases)
	{
		++counts[one.series];
		if (before && before->series == one.series)
		{
			const bool grows = one.options.rate < before->options.rate || one.copies > before->copies ||
							   one.options.height_px > before->options.height_px || one.base_triangles > before->base_triangles;
			EXPECT_TRUE(grows) << one.label();
		}
		before = &one;
	}
	EXPECT_EQ(counts, (std::map<std::string, size_t>{ { "triangles", 11 }, { "base", 5 }, { "instances", 7 }, { "size", 5 } }));
}

TEST(benchSettings, quickSetsWhatLaterOptionsMayChange)
{
	const Settings settings = settingsOf({ "--frames", "3", "--quick", "--cull=off" });
	EXPECT_EQ(settings.base.frames, 3u);
	EXPECT_EQ(settings.base.warmup, 2u);
	EXPECT_EQ(settings.culls, std::vector<bool>{ false });
	EXPECT_EQ(settings.rates, (std::vector<float>{ 6.93f, 1.73f }));
	EXPECT_EQ(settingsOf({ "--scaling=size" }).scaling, std::vector<std::string>{ "size" });
	EXPECT_EQ(settingsOf({ "--capacity", "part_triangles=7" }).base.capacities.at("part_triangles"), 7u);
}

TEST(benchSettings, refusesByNameAndSaysWhatIsRight)
{
	EXPECT_EQ(refusal({ "--cull", "maybe" }), "--cull maybe: on, off or both is right");
	EXPECT_NE(refusal({ "--raster", "auto" }).find("some of "), std::string::npos);
	EXPECT_NE(refusal({ "--rates", "0" }).find("numbers above 0"), std::string::npos);
	EXPECT_NE(refusal({ "--rate", "4" }).find("no such option"), std::string::npos);
	EXPECT_NE(refusal({ "--out" }).find("FOLDER is missing"), std::string::npos);
	EXPECT_NE(refusal({ "sphere" }).find("options start with --"), std::string::npos);
	EXPECT_NE(refusal({ "--quick=1" }).find("takes no value"), std::string::npos);
	EXPECT_FALSE(tableCases(settingsOf({ "--scene", "teapot" })));
}

TEST(benchTable, aRowHoldsMedianSpreadPassesAndSpeedUp)
{
	Row row = rowOf({ 4, 1, 2, 3 });
	row.peer = PeerTime{ "sphere x1", 1920, 1080, 1, 10, 6.809, true };
	const CsvTable csv = csvOf({ row });
	EXPECT_EQ(csv.at(0, "gpu_ms_median"), "2.500000");
	EXPECT_EQ(csv.at(0, "gpu_ms_min"), "1.000000");
	EXPECT_EQ(csv.at(0, "gpu_ms_max"), "4.000000");
	EXPECT_EQ(csv.at(0, "micro_mtri"), "6.809000");
	EXPECT_EQ(csv.at(0, "rate"), "0.866");
	EXPECT_EQ(csv.at(0, "speed_up"), "4.0000");
	EXPECT_EQ(csv.at(0, "pass_shade_ms"), "0.625000");
	EXPECT_EQ(csv.at(0, "pass_trace_ms"), "");
	const std::string page = tablePage(std::vector{ row }, {});
	EXPECT_NE(page.find("| 2.500 | 1.000 | 4.000 | 10.00* | 4.00* |"), std::string::npos) << page;
}

TEST(benchTable, coarsenedAndFailedRowsDoNotCount)
{
	Row coarsened = rowOf({ 1 });
	coarsened.state = RowState::Coarsened;
	coarsened.peer = PeerTime{ "sphere x1", 1920, 1080, 1, 10, {}, false };
	Row failed = rowOf({});
	failed.state = RowState::Failed;
	failed.error = "submitting: device lost, \"really\"";
	EXPECT_FALSE(coarsened.speedUp());
	const CsvTable csv = csvOf({ coarsened, failed });
	EXPECT_EQ(csv.at(0, "speed_up"), "");
	EXPECT_EQ(csv.at(1, "gpu_ms_median"), "");
	EXPECT_EQ(csv.at(1, "error"), failed.error);
	EXPECT_EQ(parseCsv(csvText(csv), "t")->rows, csv.rows);
	const std::string page = tablePage(std::vector{ coarsened, failed }, {});
	EXPECT_NE(page.find("coarsened: does not count"), std::string::npos);
	EXPECT_NE(page.find("failed: submitting: device lost"), std::string::npos);
	EXPECT_TRUE(compareTables(csv, csv, "t")->rows.empty());
}

TEST(benchTable, everyLineOfATableHasAsManyCells)
{
	Row failed = rowOf({});
	failed.state = RowState::Failed;
	for (const std::string& page : { tablePage(std::vector{ rowOf({ 1 }), failed }, {}), [&] {
										Row row = rowOf({ 1 });
										row.what.series = failed.what.series = "size";
										return scalingPage(std::vector{ row, failed }, {});
									}() })
	{
		std::set<long> bars;
		for (size_t at = page.find("\n|"); at != std::string::npos; at = page.find("\n|", at + 1))
			bars.insert(std::count(page.begin() + long(at) + 1, page.begin() + long(page.find('\n', at + 1)), '|'));
		EXPECT_EQ(bars.size(), 1u) << page;
	}
}

TEST(benchCompare, marksRowsThatGotMoreThanTenPercentSlower)
{
	const CsvTable stored = csvOf({ rowOf({ 1 }, 4), rowOf({ 1 }, 2), rowOf({ 1 }, 1) });
	const CsvTable now = csvOf({ rowOf({ 1.09 }, 4), rowOf({ 1.11 }, 2), rowOf({ 1 }, 8) });
	const Result<Comparison> comparison = compareTables(now, stored, "stored.csv");
	ASSERT_TRUE(comparison) << comparison.error().message;
	ASSERT_EQ(comparison->rows.size(), 2u);
	EXPECT_FALSE(comparison->rows[0].isSlower());
	EXPECT_TRUE(comparison->rows[1].isSlower());
	EXPECT_EQ(comparison->unmatched, 2u);
	EXPECT_EQ(comparison->stored_device, "");
	EXPECT_FALSE(compareTables(now, *parseCsv("a,b\n1,2\n", "x.csv"), "x.csv"));
}

TEST(benchScaling, costsPerUnitComeFromTimesAndCounts)
{
	std::vector<Row> rows = { rowOf({ 1 }), rowOf({ 3 }) };
	for (Row& row : rows)
		row.what.series = "instances";
	rows[0].what.copies = 1000;
	rows[1].what.copies = 2000;
	addUnitCosts(rows);
	EXPECT_DOUBLE_EQ(rows[0].ns_per_unit, 1000);
	EXPECT_DOUBLE_EQ(rows[1].ns_per_unit, 1500);
	EXPECT_EQ(rows[0].ns_per_added_unit, 0);
	EXPECT_DOUBLE_EQ(rows[1].ns_per_added_unit, 2000);
	EXPECT_EQ(csvOf(rows).at(1, "ns_per_added_unit"), "2000");
	EXPECT_NE(scalingPage(rows, {}).find("Time against instances"), std::string::npos);
}

}  // namespace

}  // namespace tessera::bench::test
