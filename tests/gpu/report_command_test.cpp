// `tessera report` as a user runs it: files, figures that hang together, and going on after an interruption.
#include "base/file.h"
#include "cpu/program_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace tessera::test
{

namespace
{

using nlohmann::json;

class reportCommand : public testing::Test
{
protected:
	void SetUp() override
	{
		const ProgramRun run = runTessera("info");
		if (run.exit_code == 4)
			GTEST_SKIP() << run.errors;
	}
};

constexpr const char* kArguments = "report builtin:quad --size 96x64 --frames 3 --warmup 1 --measure-left-out off -o ";

std::string textOf(const std::string& file)
{
	const auto bytes = readFile(scratchFolder() / file);
	EXPECT_TRUE(bytes) << file;
	return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "";
}

}  // namespace

TEST_F(reportCommand, finerRatesHaveSmallerErrorsAndEveryFigureIsThere)
{
	const ProgramRun run =
		runTessera(std::string(kArguments) + "figures --rasters soft,indexed --rates 16,2 --max-error-px 100 --max-ms 1e6 --quiet");
	ASSERT_EQ(run.exit_code, 0) << run.errors;
	const json report = json::parse(textOf("figures/report.json"), nullptr, false);
	ASSERT_TRUE(report.is_object());
	ASSERT_GE(report["runs"].size(), 2u);
	EXPECT_EQ(report["advice"].size(), 2u);
	EXPECT_FALSE(report["left_out"].empty());
	double last = 1e30;
	for (const json& one : report["runs"])
	{
		EXPECT_EQ(one["failure"], "");
		EXPECT_EQ(one["frames"], 3);
		EXPECT_GT(one["gpu_ms"]["min"], 0);
		EXPECT_FALSE(one["passes"].empty());
		EXPECT_GT(one["counts"]["micro_triangles"], 0);
		// Nothing of the quad lies outside the picture: what the device drew is what was measured.
		EXPECT_EQ(one["surface"]["micro_triangles"], one["counts"]["micro_triangles"]);
		EXPECT_EQ(one["surface"]["numerics"]["not_finite"], 0);
		EXPECT_EQ(one["surface"]["numerics"]["differing_edges"], 0);
		EXPECT_GT(one["surface"]["visible"]["samples"], 1000);
		EXPECT_GT(one["image"]["ssim"], 0.3);
		if (one["setting"]["raster"] != "soft")
			continue;
		EXPECT_LT(one["surface"]["whole"]["px"]["rms"], last) << one["setting"];
		last = one["surface"]["whole"]["px"]["rms"];
	}
	for (const char* file : { "report.html", "report.csv", "runs.jsonl", "plots/error_time_seen_p99.svg", "pictures/rate2_soft_edge_96x64.png" })
		EXPECT_TRUE(std::filesystem::exists(scratchFolder() / "figures" / file)) << file;
}

TEST_F(reportCommand, goesOnWhereItWasInterrupted)
{
	const std::string arguments = std::string(kArguments) + "resumed --raster soft --rates 40,16";
	ASSERT_EQ(runTessera(arguments + " --quiet").exit_code, 0);
	const std::string whole = textOf("resumed/runs.jsonl");
	const auto lines = std::count(whole.begin(), whole.end(), '\n');
	// Cut within the last line: that run alone is done again.
	ASSERT_TRUE(writeFile(scratchFolder() / "resumed/runs.jsonl", std::string_view(whole).substr(0, whole.size() - 40)));
	const ProgramRun again = runTessera(arguments + " --resume");
	ASSERT_EQ(again.exit_code, 0) << again.errors;
	const std::string resumed = textOf("resumed/runs.jsonl");
	EXPECT_EQ(std::count(resumed.begin(), resumed.end(), '\n'), lines);
	const size_t last_line = whole.rfind('\n', whole.size() - 2);
	EXPECT_EQ(resumed.substr(0, last_line), whole.substr(0, last_line));
	// Other facts are refused, and nothing is lost.
	const ProgramRun other = runTessera(std::string(kArguments) + "resumed --raster soft --rates 40,16 --resume --displacement-scale 2 --quiet");
	EXPECT_EQ(other.exit_code, 3);
	EXPECT_NE(other.errors.find("displacement_scale"), std::string::npos) << other.errors;
	EXPECT_EQ(textOf("resumed/runs.jsonl"), resumed);
}

TEST_F(reportCommand, whatTheSceneDoesNotNeedIsMeasuredByForcingItOn)
{
	const std::string arguments = "report builtin:quad --size 96x64 --frames 3 --warmup 1 --raster soft --rates 8 --quiet -o left_out";
	const ProgramRun run = runTessera(arguments);
	ASSERT_EQ(run.exit_code, 0) << run.errors;
	const json report = json::parse(textOf("left_out/report.json"), nullptr, false);
	ASSERT_TRUE(report.is_object());
	EXPECT_EQ(report["runs"].size(), 1u);
	size_t measured = 0;
	for (const json& item : report["left_out"])
	{
		// A time, or why there is none.
		EXPECT_NE(item["saved_ms"].is_null(), item["not_measured"] == "") << item;
		measured += item["saved_ms"].is_null() ? 0 : 1;
		if (item["name"] == "seam_corner_indices" || item["name"] == "HAS_SEAMS")
		{
			EXPECT_EQ(item["measured_with"], "HAS_SEAMS");
		}
		if (item["name"] == "draw_indexed")
		{
			EXPECT_TRUE(item["saved_ms"].is_null());
		}
	}
	EXPECT_GT(measured, 8u);
	// All of it is in the log, and not measured again.
	const std::string log = textOf("left_out/runs.jsonl");
	EXPECT_NE(log.find("\"forced\":\"HAS_SEAMS\""), std::string::npos);
	ASSERT_EQ(runTessera(arguments + " --resume").exit_code, 0);
	EXPECT_EQ(textOf("left_out/runs.jsonl"), log);
	const json again = json::parse(textOf("left_out/report.json"), nullptr, false);
	EXPECT_EQ(again["left_out"], report["left_out"]);
}

TEST_F(reportCommand, againstTheOriginalTheErrorFallsToTheFloor)
{
	// The original: the quad's surface as it is at a fine rate.
	const std::filesystem::path original = scratchFolder() / "quad.glb", other = scratchFolder() / "other.glb";
	ASSERT_EQ(runTessera("export builtin:quad --size 96x64 --rate 0.5 --quiet -o " + original.string()).exit_code, 0);
	ASSERT_EQ(runTessera("export builtin:quad --size 96x64 --rate 4 --quiet -o " + other.string()).exit_code, 0);
	const std::string arguments = std::string(kArguments) + "original --raster soft --rates 40,8,1 --quiet --original ";
	const ProgramRun run = runTessera(arguments + original.string());
	ASSERT_EQ(run.exit_code, 0) << run.errors;
	const json report = json::parse(textOf("original/report.json"), nullptr, false);
	ASSERT_TRUE(report.is_object() && report["runs"].size() == 3);
	const double floor = report["original"]["sizes"][0]["floor"]["world"]["rms"];
	double last = 1e30;
	for (const json& one : report["runs"])
	{
		const json& error = one["surface"]["original"];
		EXPECT_EQ(error["floor"]["world"]["rms"], floor);
		EXPECT_LT(error["drawn"]["world"]["rms"], last * 0.7) << one["setting"];
		EXPECT_GT(error["drawn"]["px"]["max"], 0);
		last = error["drawn"]["world"]["rms"];
	}
	EXPECT_LT(floor, last);
	EXPECT_LT(last, 0.05 * double(report["runs"][0]["surface"]["original"]["undisplaced"]["world"]["rms"]));
	EXPECT_NE(textOf("original/report.html").find("Against the original"), std::string::npos);
	EXPECT_NE(textOf("original/report.csv").find(",original_rms_world,"), std::string::npos);
	EXPECT_TRUE(std::filesystem::exists(scratchFolder() / "original/plots/original_triangles_rms.svg"));
	// It goes on, but not with another file, nor with the same name for something else.
	const std::string log = textOf("original/runs.jsonl");
	EXPECT_EQ(runTessera(arguments + original.string() + " --resume").exit_code, 0);
	const ProgramRun another = runTessera(arguments + other.string() + " --resume");
	EXPECT_EQ(another.exit_code, 3);
	EXPECT_NE(another.errors.find("options/original"), std::string::npos) << another.errors;
	std::filesystem::copy_file(other, original, std::filesystem::copy_options::overwrite_existing);
	const ProgramRun changed = runTessera(arguments + original.string() + " --resume");
	EXPECT_EQ(changed.exit_code, 3);
	EXPECT_NE(changed.errors.find("original/area"), std::string::npos) << changed.errors;
	EXPECT_EQ(textOf("original/runs.jsonl"), log);
}

TEST_F(reportCommand, anOriginalThatCannotBeReadIsNamed)
{
	const std::string arguments = std::string(kArguments) + "unreadable --rates 8 --quiet --original ";
	const ProgramRun missing = runTessera(arguments + "/no/such/model.glb");
	EXPECT_EQ(missing.exit_code, 3);
	EXPECT_NE(missing.errors.find("--original: /no/such/model.glb"), std::string::npos) << missing.errors;
	const std::filesystem::path broken = scratchFolder() / "broken.glb", empty = scratchFolder() / "empty.gltf";
	ASSERT_TRUE(writeFile(broken, std::string_view("no model")));
	EXPECT_EQ(runTessera(arguments + broken.string()).exit_code, 3);
	ASSERT_TRUE(writeFile(empty, std::string_view(R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"scene":0,"nodes":[{"name":"none"}]})")));
	const ProgramRun nothing = runTessera(arguments + empty.string());
	EXPECT_EQ(nothing.exit_code, 3);
	EXPECT_NE(nothing.errors.find("triangles"), std::string::npos) << nothing.errors;
	for (const ProgramRun& run : { missing, nothing })
		EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
	EXPECT_EQ(runTessera(arguments + "builtin:quad --grid 2x1").exit_code, 2);
	EXPECT_FALSE(std::filesystem::exists(scratchFolder() / "unreadable"));
}

TEST_F(reportCommand, alongACameraPathFiguresAreThoseOfItsKeysTogether)
{
	const std::string keys[] = {
		R"("eye": [0, 1.2, 1.6], "target": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 50)",
		R"("eye": [0.4, 0.7, 0.9], "target": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 40)",
		R"("eye": [1.5, 2, 1], "target": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 60)",
	};
	const auto runAlong = [&](const std::string& name, std::span<const std::string> cameras) {
		std::string path;
		for (size_t i = 0; i < cameras.size(); ++i)
			path += fmt::format("{}{{\"time_s\": {}, {}}}", i > 0 ? ", " : "", i, cameras[i]);
		const std::filesystem::path file = scratchFolder() / (name + ".json");
		EXPECT_TRUE(writeFile(file, std::string_view("{\"keys\": [" + path + "]}")));
		const ProgramRun run = runTessera(fmt::format("{}{} --raster soft --rates 24 --camera-path {} --quiet", kArguments, name, file.string()));
		EXPECT_EQ(run.exit_code, 0) << run.errors;
		const json report = json::parse(textOf(name + "/report.json"), nullptr, false);
		EXPECT_TRUE(report.is_object() && report["runs"].size() == 1) << name;
		return report.is_object() ? report["runs"][0] : json();
	};
	const json all = runAlong("along_all", keys);
	std::vector<json> alone;
	for (size_t i = 0; i < 3; ++i)
		alone.push_back(runAlong(fmt::format("along_{}", i), std::span(keys).subspan(i, 1)));
	ASSERT_FALSE(HasFailure());
	EXPECT_EQ(all["cameras"], 3);
	EXPECT_EQ(all["frames"], 3);  // shared out
	uint64_t micro_triangles = 0;
	for (const char* region : { "visible", "whole" })
	{
		double most = 0, squares = 0, sum = 0;
		for (const json& one : alone)
		{
			const json& px = one["surface"][region]["px"];
			most = std::max(most, double(px["max"]));
			squares += double(px["rms"]) * double(px["rms"]) / 3;
			sum += double(px["p99"]) / 3;
		}
		const json& px = all["surface"][region]["px"];
		EXPECT_NEAR(px["max"], most, 1e-9) << region;
		EXPECT_NEAR(px["rms"], std::sqrt(squares), 1e-9) << region;
		EXPECT_NEAR(px["p99"], sum, 1e-9) << region;
	}
	for (const json& one : alone)
		micro_triangles += uint64_t(one["counts"]["micro_triangles"]);
	EXPECT_EQ(all["counts"]["micro_triangles"], micro_triangles / 3);
	// The picture is that of the first key.
	EXPECT_EQ(all["image"], alone[0]["image"]);
	// A single key is a camera like any other, and what is no path is refused.
	EXPECT_EQ(alone[0]["cameras"], 1);
	EXPECT_EQ(runTessera(std::string(kArguments) + "along_none --raster soft --rates 12 --camera-path /no/such/path.json --quiet").exit_code, 3);
}

TEST_F(reportCommand, wrongUsageIsRefusedBeforeAnythingIsWritten)
{
	EXPECT_EQ(runTessera(std::string(kArguments) + "none --rates 4,fast --quiet").exit_code, 2);
	EXPECT_EQ(runTessera(std::string(kArguments) + "none --view wireframe --quiet").exit_code, 2);
	EXPECT_EQ(runTessera("report builtin:quad --rasters auto,soft -o none --quiet").exit_code, 2);
	EXPECT_EQ(runTessera("report builtin:quad --force batches,nothing_of_that_name -o none --quiet").exit_code, 2);
	EXPECT_FALSE(std::filesystem::exists(scratchFolder() / "none"));
}

TEST_F(reportCommand, renderHoldsTheErrorThatIsAskedFor)
{
	const ProgramRun run = runTessera("render builtin:quad --size 96x64 --max-error-px 1.5 --stats - --quiet");
	ASSERT_EQ(run.exit_code, 0) << run.errors;
	const json stats = json::parse(run.output, nullptr, false);
	ASSERT_TRUE(stats.is_object());
	EXPECT_LE(stats["error"]["seen_max_px"], 1.5);
	EXPECT_FLOAT_EQ(stats["frame"]["rate_granted"], stats["options"]["rate"]);
	// Measured again by the report at that rate; and a rate a quarter coarser is too coarse.
	const double rate = stats["options"]["rate"];
	ASSERT_EQ(runTessera(fmt::format("{}held --raster soft --rates {},{} --quiet", kArguments, rate, rate * 1.25)).exit_code, 0);
	const json report = json::parse(textOf("held/report.json"), nullptr, false);
	EXPECT_LE(report["runs"][0]["surface"]["visible"]["px"]["max"], 1.5);
	EXPECT_GT(report["runs"][1]["surface"]["visible"]["px"]["max"], 1.5 * 0.97);
	// What no rate can hold is said.
	const ProgramRun never = runTessera("render builtin:quad --size 96x64 --max-error-px 1e-5 --quiet");
	EXPECT_EQ(never.exit_code, 3);
	EXPECT_NE(never.errors.find("not held"), std::string::npos) << never.errors;
}

TEST_F(reportCommand, renderGoesAsFarAsATimeBudgetAsksFor)
{
	// Times cannot be told before, but that nothing is that quick can: every frame is coarsened, down to the coarsest rate there is.
	const ProgramRun run = runTessera("render builtin:quad --size 48x32 --rate 8 --max-ms 0.001 --frames 5 --stats -");
	ASSERT_EQ(run.exit_code, 0) << run.errors;
	const json stats = json::parse(run.output, nullptr, false);
	ASSERT_TRUE(stats.is_object());
	const json& budget = stats["budget"];
	EXPECT_EQ(budget["rate"], 256);
	EXPECT_EQ(budget["frames"], 5);
	EXPECT_EQ(budget["frames_within_a_tenth"], 0);
	EXPECT_EQ(budget["frames_over_a_tenth_more"], 5);
	EXPECT_GT(budget["settling_frames"], 3);
	EXPECT_FLOAT_EQ(stats["frame"]["rate_wanted"], 256);
	EXPECT_NE(run.errors.find("over a tenth more"), std::string::npos) << run.errors;
	// What any frame keeps lets the rate become as fine as it gets, here within a picture of a few pixels.
	const ProgramRun roomy = runTessera("render builtin:quad --size 6x4 --rate 0.2 --max-ms 1e6 --stats - --quiet");
	ASSERT_EQ(roomy.exit_code, 0) << roomy.errors;
	EXPECT_EQ(json::parse(roomy.output, nullptr, false)["budget"]["rate"], 1.0 / 16);
	EXPECT_EQ(runTessera("render builtin:quad --max-ms 1 --max-error-px 1 --quiet").exit_code, 2);
}

}  // namespace tessera::test
