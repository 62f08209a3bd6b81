// What a report says of measurements: the front, advice, the log of runs, tables, charts and the page.
#include "base/file.h"
#include "output/png.h"
#include "report/chart.h"
#include "report/heat.h"
#include "report/page_original.h"
#include "report/report_data.h"
#include "report/run_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <unistd.h>

namespace tessera::test
{

namespace
{

using namespace report;
namespace fs = std::filesystem;

fs::path scratch(const std::string& name)
{
	const fs::path folder = fs::temp_directory_path() / fmt::format("tessera_report_files_{}", getpid()) / name;
	fs::remove_all(folder);
	fs::create_directories(folder);
	return folder;
}

report::Run runOf(double rate, const std::string& raster, double ms, double p99_px)
{
	report::Run run;
	run.setting = { rate, raster, "edge", 64, 48 };
	run.rate_granted = rate;
	run.frames = 3;
	run.gpu_ms = timeFigures({ ms, ms * 0.9, ms * 1.2 });
	run.passes = { { "shade", timeFigures({ ms / 2 }) }, { "raster_micro", timeFigures({ ms / 3 }) } };
	run.counts.micro_triangles = static_cast<uint64_t>(1e5 / rate);
	SurfaceErrors surface;
	surface.visible.samples = surface.whole.samples = 1000;
	surface.visible.px = { 3 * p99_px, p99_px / 2, p99_px };
	surface.whole.px = { 4 * p99_px, p99_px / 2, 1.5 * p99_px };
	surface.numerics.first_problem = "a \"problem\" with <marks> & more";
	run.surface = surface;
	run.image = ImageError{ 31.5, 0.97, std::nullopt, 10, 2, 500 };
	run.reference = { 0.25, 0.25, 99, "pictures/reference.png" };
	return run;
}

// `falls` times the floor away.
AgainstOriginal againstOriginal(double falls)
{
	AgainstOriginal original;
	for (auto [error, rms] : { std::pair(&original.drawn, 0.25 * falls), std::pair(&original.floor, 0.25), std::pair(&original.undisplaced, 0.5) })
	{
		error->world = error->to_original_world = { 4 * rms, rms, 2 * rms };
		error->to_surface_world = { 3 * rms, rms / 2, rms };
		error->relative = scaled(error->world, 0.125);
		error->px = scaled(error->world, 8);
		error->samples = 65536;
		error->change = 0.005;
		error->converged = true;
	}
	original.floor_triangles = 1234;
	return original;
}

std::vector<report::Run> someRuns()
{
	return { runOf(8, "soft", 1.0, 2.0), runOf(8, "mesh", 0.8, 2.0), runOf(4, "soft", 1.5, 0.9), runOf(4, "mesh", 3.0, 0.9),
			 runOf(2, "soft", 4.0, 0.4) };
}

std::vector<const report::Run*> pointersTo(const std::vector<report::Run>& runs)
{
	std::vector<const report::Run*> pointers;
	for (const report::Run& run : runs)
		pointers.push_back(&run);
	return pointers;
}

std::string textOf(const fs::path& path)
{
	const auto bytes = readFile(path);
	EXPECT_TRUE(bytes) << path;
	return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "";
}

// Every tag is closed in order; attributes hold no stray marks.
bool isWellFormed(const std::string& xml)
{
	std::vector<std::string> open;
	for (size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1))
	{
		const size_t end = xml.find('>', at);
		if (end == std::string::npos)
			return false;
		const std::string tag = xml.substr(at + 1, end - at - 1);
		if (tag[0] == '?' || tag.back() == '/')
			continue;
		const std::string name = tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" /", 1) - (tag[0] == '/' ? 1 : 0));
		if (tag[0] != '/')
			open.push_back(name);
		else if (open.empty() || open.back() != tag.substr(1))
			return false;
		else
			open.pop_back();
	}
	return open.empty();
}

}  // namespace

// --- recommendation --------------------------------------------------------------------------------------------------------------

TEST(recommend, frontHoldsExactlyTheRunsThatNoOtherBeats)
{
	std::mt19937 random(1);
	std::vector<report::Run> runs;
	for (int i = 0; i < 200; ++i)
		runs.push_back(runOf(1, "soft", double(random() % 50 + 1), double(random() % 50 + 1)));
	const std::vector<const report::Run*> all = pointersTo(runs);
	const std::vector<size_t> front = paretoFront(all, ErrorKind::SeenP99);
	ASSERT_FALSE(front.empty());
	const auto time = [&](size_t i) {
		return all[i]->gpu_ms.median;
	};
	const auto error = [&](size_t i) {
		return *errorOf(*all[i], ErrorKind::SeenP99);
	};
	for (size_t i = 1; i < front.size(); ++i)
	{
		EXPECT_LT(time(front[i - 1]), time(front[i]));
		EXPECT_GT(error(front[i - 1]), error(front[i]));
	}
	for (size_t i = 0; i < all.size(); ++i)
		EXPECT_TRUE(std::any_of(front.begin(), front.end(), [&](size_t f) { return time(f) <= time(i) && error(f) <= error(i); })) << i;
}

TEST(recommend, cheapestUnderAnErrorAndBestWithinATime)
{
	std::vector<report::Run> runs = someRuns();
	report::Run failed;
	failed.setting = { 1, "soft", "edge", 64, 48 };
	failed.failure = "no memory";
	runs.push_back(failed);
	const std::vector<Advice> advice = recommend(runs, { 3.0, 1.6 });
	ASSERT_EQ(advice.size(), 2u);
	EXPECT_EQ(advice[0].run, &runs[2]);
	EXPECT_EQ(advice[1].run, &runs[2]);
	EXPECT_EQ(recommend(runs, { 6.0, std::nullopt })[0].run, &runs[1]);
	EXPECT_EQ(recommend(runs, { std::nullopt, 10.0 })[0].run, &runs[4]);
	const Advice none = recommend(runs, { 1.0, std::nullopt })[0];
	EXPECT_EQ(none.run, nullptr);
	EXPECT_NE(none.text.find("none of those tried"), std::string::npos);
	EXPECT_TRUE(recommend(runs, {}).empty());
}

TEST(figures, medianQuartilesAndPercentilesOfKnownValues)
{
	const TimeFigures times = timeFigures({ 5, 1, 2, 4, 3 });
	EXPECT_EQ(times.median, 3);
	EXPECT_EQ(times.lower_quartile, 2);
	EXPECT_EQ(times.upper_quartile, 4);
	EXPECT_EQ(times.min, 1);
	EXPECT_EQ(times.max, 5);
	EXPECT_EQ(timeFigures({ 1, 2 }).median, 1.5);
	std::vector<Weighted> values;
	for (int i = 1; i <= 1000; ++i)
		values.push_back({ double(i), 1 });
	values.push_back({ 5000, 0 });  // weighs nothing
	const Figures figures = figuresOf(values);
	EXPECT_EQ(figures.max, 1000);
	EXPECT_EQ(figures.p99, 990);
	EXPECT_NEAR(figures.rms, std::sqrt(1001.0 * 2001 / 6), 1e-9);
	EXPECT_EQ(figuresOf({}), Figures());
}

// --- the log of runs -------------------------------------------------------------------------------------------------------------

TEST(runLog, givesBackEveryRunAfterAnyInterruption)
{
	const fs::path path = scratch("interrupted") / "runs.jsonl";
	const nlohmann::json facts = { { "scene", "builtin:quad" }, { "size", 0.1 } };
	const std::vector<report::Run> runs = someRuns();
	{
		Result<RunLog> log = RunLog::start(path, facts);
		ASSERT_TRUE(log);
		for (const report::Run& run : runs)
			ASSERT_TRUE(log->add(run));
	}
	const std::string text = textOf(path);
	EXPECT_EQ(size_t(std::count(text.begin(), text.end(), '\n')), runs.size() + 1);
	for (size_t cut = 0; cut <= text.size(); cut += cut + 97 < text.size() ? 97 : 1)
	{
		ASSERT_TRUE(writeFile(path, std::string_view(text).substr(0, cut)));
		Result<RunLog> log = RunLog::resume(path, facts);
		ASSERT_TRUE(log) << cut << ": " << log.error().message;
		const auto whole_lines = size_t(std::count(text.begin(), text.begin() + std::ptrdiff_t(cut), '\n'));
		ASSERT_EQ(log->runs().size(), whole_lines > 0 ? whole_lines - 1 : 0) << cut;
		for (const report::Run& run : runs)
			if (!log->find(run.setting))
			{
				ASSERT_TRUE(log->add(run));
			}
		EXPECT_EQ(textOf(path), text) << cut;
	}
}

TEST(runLog, refusesToGoOnWithOtherFactsAndBrokenLines)
{
	const fs::path path = scratch("other") / "runs.jsonl";
	ASSERT_TRUE(RunLog::start(path, { { "options", { { "frames", 3 } } } }));
	const auto other = RunLog::resume(path, { { "options", { { "frames", 4 } } } });
	ASSERT_FALSE(other);
	EXPECT_NE(other.error().message.find("options/frames is 3 there and 4 now"), std::string::npos) << other.error().message;
	for (const char* broken : { "{}\n", "[1\n", "no\n" })
	{
		std::ofstream(path, std::ios::app) << broken;
		const auto log = RunLog::resume(path, { { "options", { { "frames", 3 } } } });
		ASSERT_FALSE(log);
		EXPECT_NE(log.error().message.find("line 2"), std::string::npos) << log.error().message;
		ASSERT_TRUE(RunLog::start(path, { { "options", { { "frames", 3 } } } }));
	}
}

TEST(runLog, refusesToGoOnWithAnotherOriginal)
{
	const fs::path path = scratch("original") / "runs.jsonl";
	const auto factsOf = [](const char* file, int triangles) {
		return nlohmann::json{ { "options", { { "original", file } } }, { "original", { { "triangles", triangles } } } };
	};
	ASSERT_TRUE(RunLog::start(path, factsOf("high.glb", 12)));
	EXPECT_TRUE(RunLog::resume(path, factsOf("high.glb", 12)));
	const auto renamed = RunLog::resume(path, factsOf("other.glb", 12));
	ASSERT_FALSE(renamed);
	EXPECT_NE(renamed.error().message.find("options/original is \"high.glb\" there and \"other.glb\" now"), std::string::npos)
		<< renamed.error().message;
	const auto changed = RunLog::resume(path, factsOf("high.glb", 13));
	ASSERT_FALSE(changed);
	EXPECT_NE(changed.error().message.find("original/triangles is 12 there and 13 now"), std::string::npos) << changed.error().message;
}

TEST(runLog, alongAPathTheOriginalsFiguresAreThoseOfItsKeysTogether)
{
	std::vector<SurfaceErrors> cameras(2);
	cameras[0].original = againstOriginal(2);
	cameras[1].original = againstOriginal(4);
	cameras[1].original->drawn.converged = false;
	const SurfaceErrors all = alongPath(cameras);
	ASSERT_TRUE(all.original);
	const OriginalError& drawn = all.original->drawn;
	EXPECT_DOUBLE_EQ(drawn.px.max, 32);
	EXPECT_DOUBLE_EQ(drawn.px.p99, 12);
	EXPECT_DOUBLE_EQ(drawn.px.rms, std::sqrt((4.0 * 4 + 8 * 8) / 2));
	EXPECT_FALSE(drawn.converged);
	EXPECT_EQ(drawn.samples, 2 * 65536u);
	EXPECT_DOUBLE_EQ(all.original->floor.world.rms, 0.25);
	EXPECT_EQ(all.original->floor_triangles, 1234u);
	cameras[1].original.reset();
	EXPECT_FALSE(alongPath(cameras).original);
}

TEST(runLog, aRunSurvivesJsonExactly)
{
	std::vector<report::Run> runs = someRuns();
	runs.push_back(runs[0]);
	runs.back().surface->original = againstOriginal(2);
	for (const report::Run& run : runs)
	{
		const Result<report::Run> again = runFromJson(nlohmann::json::parse(runJson(run).dump()), "test");
		ASSERT_TRUE(again);
		EXPECT_EQ(runJson(*again), runJson(run));
	}
}

// --- files -----------------------------------------------------------------------------------------------------------------------

TEST(chart, isWellFormedWhateverItIsGiven)
{
	LineChart chart = { "a < b & \"c\"", "x", "y", {}, {}, "front" };
	EXPECT_TRUE(isWellFormed(standaloneSvg(chartSvg(chart))));
	chart.series = { { "one <two>", 0, { { 0, 0, "zero & none", false }, { 1e-12, 1e12, "far", true } }, true },
					 { "single", 1, { { 3, 3, "", true } }, true },
					 { "none", 2, {}, true } };
	chart.front = { { 1, 1, "", true }, { 2, 0.5, "", true } };
	const std::string svg = standaloneSvg(chartSvg(chart));
	EXPECT_TRUE(isWellFormed(svg)) << svg;
	EXPECT_EQ(svg.find("nan"), std::string::npos);
	EXPECT_EQ(svg.find("inf"), std::string::npos);
	EXPECT_NE(svg.find("<title>zero &amp; none</title>"), std::string::npos);
	const BarChart bars = { "bars", "ms", { "a", "b" }, { { "first", { { 0, 1, "x" }, { 1, 0, "y" } }, "1 ms" }, { "empty", {}, "" } } };
	EXPECT_TRUE(isWellFormed(standaloneSvg(chartSvg(bars))));
	EXPECT_TRUE(isWellFormed(standaloneSvg(chartSvg(BarChart{}))));
}

TEST(heat, brightensWithTheErrorAndIsClearWhereNothingIsSeen)
{
	const auto lightness = [](double px) {
		const auto c = heatColor(px);
		return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
	};
	for (double px = kHeatLeastPx; px < kHeatMostPx / 1.2; px *= 1.2)
		EXPECT_LT(lightness(px), lightness(px * 1.2)) << px;
	EXPECT_EQ(heatColor(0), heatColor(kHeatLeastPx));
	EXPECT_EQ(heatColor(1e9), heatColor(kHeatMostPx));
	const std::vector<uint8_t> colors = heatColors({ 2, 1, { -1, 1 } });
	EXPECT_EQ(colors[3], 0);
	EXPECT_EQ(colors[7], 255);
}

TEST(report, saysHowFarTheOriginalIsInWordsColumnsAndPlots)
{
	const fs::path folder = scratch("against");
	ReportData data;
	data.runs = { runOf(8, "soft", 1, 2), runOf(4, "soft", 2, 1), runOf(2, "soft", 4, 0.5) };
	const std::vector<uint8_t> grey(4 * 4 * 4, 128);
	for (report::Run& run : data.runs)
	{
		run.picture = run.heat = "pictures/one.png";
		ASSERT_TRUE(writePng(folder / run.picture, 4, 4, grey, 4));
	}
	ASSERT_TRUE(writePng(folder / "pictures/reference.png", 4, 4, grey, 4));
	ASSERT_TRUE(writeReport(folder, data));
	// Without an original nothing is said of one, and its columns are empty.
	EXPECT_EQ(textOf(folder / "report.html").find("riginal"), std::string::npos);
	EXPECT_FALSE(fs::exists(folder / "plots/original_triangles_rms.svg"));
	EXPECT_TRUE(nlohmann::json::parse(textOf(folder / "report.json"))["original"].is_null());

	data.original = { "high & <low>.glb", 48000 };
	const double falls[] = { 3, 1.5, 1.04 };
	for (size_t i = 0; i < 3; ++i)
		data.runs[i].surface->original = againstOriginal(falls[i]);
	ASSERT_TRUE(writeReport(folder, data));
	const std::string html = textOf(folder / "report.html");
	for (const char* text :
		 { "high &amp; &lt;low&gt;.glb</code>, 48000 triangles", "itself lies 0.25 world units", "would be 0.5: the height maps take 50 %",
		   "from rate 8 to 2 the distance to the original goes from 0.75 to 0.26 world units", "From rate 2 on it is within 5 %",
		   ">original rms</th>", "as 1234 triangles" })
		EXPECT_NE(html.find(text), std::string::npos) << text;
	for (const char* plot : { "original_triangles_rms", "original_time_rms", "original_triangles_p99", "original_time_p99" })
	{
		const std::string svg = textOf(folder / "plots" / (std::string(plot) + ".svg"));
		EXPECT_TRUE(isWellFormed(svg)) << plot;
		EXPECT_NE(svg.find("floor: the reference surface"), std::string::npos) << plot;
	}
	const nlohmann::json json = nlohmann::json::parse(textOf(folder / "report.json"));
	EXPECT_EQ(json["original"]["sizes"][0]["floor"]["world"]["rms"], 0.25);
	EXPECT_EQ(json["runs"][1]["surface"]["original"]["drawn"]["px"]["rms"], 3);
	const std::string csv = textOf(folder / "report.csv");
	for (const char* column : { "original_rms_world", "original_max_px", "original_floor_rms_world" })
		EXPECT_NE(csv.find("," + std::string(column) + ","), std::string::npos) << column;

	// A map that does not help, and rates that stay away.
	for (report::Run& run : data.runs)
	{
		run.surface->original = againstOriginal(3);
		run.surface->original->floor.world.rms = 0.6;
	}
	EXPECT_NE(describeOriginal(data)[0].find("bring it no nearer"), std::string::npos);
	EXPECT_NE(describeOriginal(data)[1].find("None of the rates"), std::string::npos);
}

TEST(report, filesHoldEveryRunAndNeedNoNetwork)
{
	const fs::path folder = scratch("files");
	ReportData data;
	data.scene = "</script> & \"friends\"";
	data.command = "tessera report '<x>'";
	data.device = "a device";
	data.runs = someRuns();
	data.left_out = { { "buffer", "micro_vertices", "nobody <reads> it", 12345 } };
	data.limits = { 1.0, 2.0 };
	const std::vector<uint8_t> grey(4 * 4 * 4, 128);
	for (report::Run& run : data.runs)
	{
		run.picture = fmt::format("pictures/{}{}.png", run.setting.raster, run.setting.rate);
		run.heat = run.picture;
		ASSERT_TRUE(writePng(folder / run.picture, 4, 4, grey, 4));
	}
	ASSERT_TRUE(writePng(folder / "pictures/reference.png", 4, 4, grey, 4));
	const Status status = writeReport(folder, data);
	ASSERT_TRUE(status) << status.error().message;

	const std::string csv = textOf(folder / "report.csv");
	EXPECT_EQ(size_t(std::count(csv.begin(), csv.end(), '\n')), data.runs.size() + 1);
	const std::string head = csv.substr(0, csv.find('\n'));
	for (const char* column : { "rate", "raster", "gpu_ms_median", "seen_p99_px", "whole_max_mesh", "psnr_db", "ssim", "micro_triangles", "bytes" })
		EXPECT_NE(("," + head + ",").find("," + std::string(column) + ","), std::string::npos) << column;
	const nlohmann::json json = nlohmann::json::parse(textOf(folder / "report.json"));
	EXPECT_EQ(json["runs"].size(), data.runs.size());
	EXPECT_EQ(json["front"]["seen_p99"].size(), 3u);
	EXPECT_EQ(json["advice"].size(), 2u);

	const std::string html = textOf(folder / "report.html");
	EXPECT_EQ(html.find("src=\"http"), std::string::npos);
	EXPECT_EQ(html.find("href=\"http"), std::string::npos);
	EXPECT_EQ(html.find("url("), std::string::npos);
	EXPECT_EQ(html.find("friends\""), std::string::npos) << "the scene's name is not escaped";
	EXPECT_NE(html.find("nobody &lt;reads&gt; it"), std::string::npos);
	EXPECT_NE(html.find("data:image/png;base64,iVBOR"), std::string::npos);
	for (const char* plot : { "error_time_seen_p99", "error_rate_whole_max", "error_triangles_seen_rms", "time_rate", "time_passes" })
		EXPECT_TRUE(isWellFormed(textOf(folder / "plots" / (std::string(plot) + ".svg")))) << plot;
}

}  // namespace tessera::test
