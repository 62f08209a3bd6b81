// The option table and the command line: what is accepted, what is refused and in which words, what --help and the stats show.
#include "app/command_line.h"
#include "app/option_text.h"
#include "frame/lists.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace tessera::test
{

namespace
{

using Arguments = std::vector<std::string>;

AppOptions parsed(Arguments arguments)
{
	arguments.insert(arguments.begin(), "render");
	const Result<CommandLine> line = parseCommandLine(arguments);
	EXPECT_TRUE(line) << (line ? "" : line.error().message);
	return line ? line->options : AppOptions();
}

std::string refusal(const Arguments& arguments)
{
	const Result<CommandLine> line = parseCommandLine(arguments);
	if (line)
		return "accepted";
	EXPECT_EQ(line.error().code, ExitCode::Usage);
	EXPECT_EQ(line.error().message.find('\n'), std::string::npos) << line.error().message;
	return line.error().message;
}

std::string jsonKey(std::string_view name)
{
	std::string key(name);
	std::replace(key.begin(), key.end(), '-', '_');
	return key;
}

// What the command line would have to say to give these options.
Arguments printed(const AppOptions& options)
{
	Arguments arguments;
	for (const OptionDesc& option : optionTable())
		for (const std::string& value : printOption(option, options))
		{
			arguments.push_back("--" + std::string(option.name));
			if (!option.value.empty())
				arguments.push_back(value);
		}
	return arguments;
}

// A value for every option, different from its default.
const std::vector<std::pair<std::string, std::string>> kSamples = {
	{ "size", "640x480" },
	{ "eye", "1,-2.5,3e-3" },
	{ "target", "-1,0,0.1" },
	{ "up", "0,0,1" },
	{ "fov", "47.25" },
	{ "near", "0.001" },
	{ "ortho", "2.5" },
	{ "camera-path", "path.json" },
	{ "wireframe", "" },
	{ "camera", "3" },
	{ "grid", "4x3" },
	{ "grid-u", "-2,0,0" },
	{ "grid-v", "0,2,0" },
	{ "rate", "0.3" },
	{ "metric", "displaced" },
	{ "metrics", "edge,detail" },
	{ "raster", "indexed" },
	{ "cull", "backface" },
	{ "max-split", "5" },
	{ "force", "triangle_split" },
	{ "capacity", "part_triangles=1000" },
	{ "budget", "64MB" },
	{ "displacement", "a.png:0.1::stone" },
	{ "displacement-scale", "-0.7" },
	{ "view", "wireframe" },
	{ "shading", "flat" },
	{ "displacement-offset", "0.25" },
	{ "pn", "on" },
	{ "shadows", "on" },
	{ "ao", "16" },
	{ "ao-radius", "0.25" },
	{ "ray-falloff", "2.5" },
	{ "ray-hidden", "off" },
	{ "ray-sharing", "off" },
	{ "rays", "khr" },
	{ "transient-1x1x1", "off" },
	{ "transient-2x2x2", "off" },
	{ "transient-build", "fast-trace" },
	{ "position-truncation", "12" },
	{ "max-cluster-data", "256" },
	{ "max-cluster-vertices", "1000000" },
	{ "cluster-size", "128x96" },
	{ "table", "own.table" },
	{ "frames", "64" },
	{ "warmup", "16" },
	{ "rates", "7,3.5,0" },
	{ "rasters", "soft,indexed" },
	{ "sizes", "320x240,64x48" },
	{ "reference-rate", "0.125" },
	{ "original", "high.glb" },
	{ "max-error-px", "0.5" },
	{ "max-ms", "2.25" },
	{ "measure-left-out", "off" },
	{ "resume", "" },
	{ "device", "llvmpipe" },
	{ "pipelines", "" },
	{ "validate", "" },
	{ "strict", "" },
	{ "quiet", "" },
};

Arguments sampleArguments()
{
	Arguments arguments;
	for (const auto& [name, value] : kSamples)
	{
		arguments.push_back("--" + name);
		if (!value.empty())
			arguments.push_back(value);
	}
	return arguments;
}

}  // namespace

TEST(options, everyRowIsInHelpAndInTheJson)
{
	const Result<CommandLine> main_help = parseCommandLine({ "--help" }), command_help = parseCommandLine({ "info", "--help" });
	ASSERT_TRUE(main_help && command_help);
	const nlohmann::ordered_json json = optionsJson({});
	EXPECT_EQ(json.size(), optionTable().size());
	for (const OptionDesc& option : optionTable())
	{
		const std::string row = fmt::format("  --{} {}", option.name, option.value);
		EXPECT_NE(main_help->text.find(row), std::string::npos) << row;
		EXPECT_NE(command_help->text.find(row), std::string::npos) << row;
		EXPECT_TRUE(json.contains(jsonKey(option.name))) << option.name;
		EXPECT_EQ(findOption(option.name), &option);
	}
}

TEST(options, helpNamesEveryChoiceAndKeepsItsLinesShort)
{
	const std::string help = optionsHelp();
	for (const OptionDesc& option : optionTable())
	{
		const Choice* choice = std::get_if<Choice>(&option.field);
		for (std::string_view name : choice ? choice->names : std::span<const std::string_view>())
			EXPECT_NE(help.find(name), std::string::npos) << name;
	}
	for (std::string_view line : splitAt(help, '\n'))
		EXPECT_LE(line.size(), 120u) << line;
}

TEST(options, everyOptionRoundTripsThroughItsText)
{
	ASSERT_EQ(kSamples.size(), optionTable().size()) << "a row of the table has no sample here";
	const AppOptions options = parsed(sampleArguments());
	const nlohmann::ordered_json json = optionsJson(options), defaults = optionsJson({});
	EXPECT_EQ(optionsJson(parsed(printed(options))), json);
	EXPECT_EQ(optionsJson(parsed(printed({}))), defaults);
	for (const auto& [name, value] : kSamples)
		EXPECT_NE(json[jsonKey(name)], defaults[jsonKey(name)]) << name;
}

TEST(options, valuesArriveWhereTheyBelong)
{
	const AppOptions options = parsed(sampleArguments());
	EXPECT_EQ(options.width_px, 640u);
	EXPECT_EQ(options.height_px, 480u);
	EXPECT_EQ(options.eye, dvec3(1, -2.5, 0.003));
	EXPECT_EQ(options.grid_columns, 4u);
	EXPECT_EQ(options.grid_rows, 3u);
	EXPECT_EQ(options.rate, 0.3f);
	EXPECT_EQ(options.raster, Raster::Indexed);
	EXPECT_FALSE(options.cull.frustum);
	EXPECT_TRUE(options.cull.backface);
	EXPECT_EQ(options.capacities.at("part_triangles"), 1000u);
	EXPECT_EQ(options.view, ViewMode::Wireframe);
	EXPECT_FALSE(options.smooth_normals);
	EXPECT_EQ(options.cluster_triangles, 96u);
}

TEST(options, theJsonIsWhatTheStatsPromise)
{
	const nlohmann::ordered_json json = optionsJson(parsed({ "--rate", "0.1", "--raster", "mesh" }));
	EXPECT_EQ(json["rate"].dump(), "0.1");
	EXPECT_EQ(json["raster"], "mesh");
	EXPECT_EQ(json["size"].dump(), "[1920,1080]");
	EXPECT_TRUE(json["eye"].is_null());
}

TEST(options, viewsAreInTheOrderOfViewMode)
{
	const Choice& views = std::get<Choice>(findOption("view")->field);
	ASSERT_EQ(views.names.size(), static_cast<size_t>(ViewMode::Error) + 1);
	EXPECT_EQ(views.names[static_cast<size_t>(ViewMode::Shaded)], "shaded");
	EXPECT_EQ(views.names[static_cast<size_t>(ViewMode::Depth)], "depth");
	EXPECT_EQ(views.names[static_cast<size_t>(ViewMode::Wireframe)], "wireframe");
	EXPECT_EQ(views.names[static_cast<size_t>(ViewMode::Error)], "error");
}

TEST(options, theLastOfAnOptionCountsAndRepeatableOnesGather)
{
	const AppOptions options = parsed({ "--rate", "3", "--displacement", "a.png", "--displacement", "b.png", "--rate", "5", "--capacity", "batches=7",
										"--capacity", "part_triangles=8", "--capacity", "batches=9" });
	EXPECT_EQ(options.rate, 5);
	EXPECT_EQ(options.displacements, (std::vector<std::string>{ "a.png", "b.png" }));
	EXPECT_EQ(options.capacities, (std::map<std::string, uint32_t>{ { "batches", 9 }, { "part_triangles", 8 } }));
}

TEST(options, cullingTakesOnOffAndLists)
{
	const auto kinds = [](const char* text) {
		const CullOptions cull = parsed({ "--cull", text }).cull;
		return (cull.frustum ? 1 : 0) + (cull.backface ? 2 : 0) + (cull.occlusion ? 4 : 0);
	};
	EXPECT_EQ(kinds("on"), 7);
	EXPECT_EQ(kinds("off"), 0);
	EXPECT_EQ(kinds("frustum"), 1);
	EXPECT_EQ(kinds("backface"), 2);
	EXPECT_EQ(kinds("backface,frustum"), 3);
	EXPECT_EQ(kinds("occlusion"), 4);
	for (const char* text : { "", "On", "frustum,", "occluded", "on,off" })
		EXPECT_NE(refusal({ "render", "--cull", text }).find("frustum,backface"), std::string::npos) << text;
}

TEST(options, numbersOutsideTheirRangeAreRefusedWithTheRange)
{
	for (const OptionDesc& option : optionTable())
	{
		if (option.most <= option.least)
			continue;
		const std::string name = "--" + std::string(option.name);
		for (const std::string& value : { fmt::format("{}", option.least - 1), fmt::format("{}", option.most * 2), std::string("nan"),
										  std::string("inf"), std::string("x"), std::string("1x"), std::string("") })
		{
			const std::string message = refusal({ "render", name, value });
			EXPECT_EQ(message.rfind(name + " " + value, 0), 0u) << message;
			EXPECT_NE(message.find("is right"), std::string::npos) << message;
			EXPECT_NE(message.find("from"), std::string::npos) << message;
		}
		AppOptions options;
		EXPECT_TRUE(setOption(option, fmt::format("{:.0f}", option.most), options)) << name;
	}
}

TEST(options, wrongValuesAreAnsweredWithRightOnes)
{
	const auto expect = [](const Arguments& arguments, const Arguments& parts) {
		Arguments all = { "render" };
		all.insert(all.end(), arguments.begin(), arguments.end());
		const std::string message = refusal(all);
		for (const std::string& part : parts)
			EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
	};
	expect({ "--raster", "voxels" }, { "--raster voxels", "auto, soft, mesh, indexed" });
	expect({ "--metric", "curvature" }, { "--metric curvature", "edge, displaced, detail" });
	expect({ "--view", "x" }, { "--view x", "shaded", "materials" });
	expect({ "--shading", "x" }, { "smooth, flat" });
	expect({ "--size", "640" }, { "--size 640", "65536", "1920x1080" });
	expect({ "--size", "0x4" }, { "--size 0x4" });
	expect({ "--grid", "4x5000" }, { "--grid 4x5000", "4096" });
	expect({ "--eye", "1,2" }, { "--eye 1,2", "three numbers" });
	expect({ "--cluster-size", "64x63" }, { "--cluster-size 64x63", "multiple of 4" });
	expect({ "--cluster-size", "64x132" }, { "128" });
	expect({ "--capacity", "part_triangles" }, { "--capacity part_triangles", "NAME=COUNT" });
	expect({ "--capacity", "part_triangles=0" }, { "--capacity part_triangles=0", "from 1 to" });
	for (const char* budget : { "", "0", "-1MB", "64 MB", "64TB", "MB", "1e300GB", "nan" })
		expect({ "--budget", budget }, { fmt::format("--budget {}", budget), "such as 64MB" });
	expect({ "--table", "" }, { "--table", "FILE" });
	for (const ListDesc& list : listDescs())
		expect({ "--capacity", "nothing=3" }, { std::string(list.name) });
}

TEST(options, budgetsAreReadInEveryUnitAndPrintedBack)
{
	const std::pair<const char*, uint64_t> kBudgets[] = {
		{ "1", 1 },       { "500B", 500 },  { "64MB", 64'000'000 },  { "64MiB", 64u << 20 }, { "1.5GiB", 3ull << 29 },
		{ "0.5kB", 500 }, { "2KiB", 2048 }, { "3GB", 3'000'000'000 }
	};
	for (const auto& [text, bytes] : kBudgets)
	{
		const AppOptions options = parsed({ "--budget", text });
		EXPECT_EQ(options.lists_bytes, bytes) << text;
		EXPECT_EQ(parsed({ "--budget", printBytes(bytes) }).lists_bytes, bytes) << printBytes(bytes);
	}
	EXPECT_EQ(printBytes(64'000'000), "64MB");
	EXPECT_EQ(printBytes(64u << 20), "67108864B");
}

TEST(options, nothingCrashesTheParser)
{
	std::mt19937 random(1);
	constexpr std::string_view kLetters = "0123456789.,x=-+e:onfabc";
	for (int i = 0; i < 20000; ++i)
	{
		const OptionDesc& option = optionTable()[random() % optionTable().size()];
		std::string text;
		for (size_t length = random() % 12; text.size() < length;)
			text += kLetters[random() % kLetters.size()];
		AppOptions options;
		const Status status = setOption(option, text, options);
		if (!status)
		{
			EXPECT_EQ(status.error().code, ExitCode::Usage);
			continue;
		}
		AppOptions again;
		for (const std::string& value : printOption(option, options))
			ASSERT_TRUE(setOption(option, value, again)) << option.name << " " << value;
		EXPECT_EQ(optionsJson(options), optionsJson(again)) << option.name << " " << text;
	}
}

TEST(options, whatAChangeMakesStaleIsTheMostOfItsOptions)
{
	EXPECT_EQ(staleAfter({}, {}), Rebuild::Nothing);
	EXPECT_EQ(staleAfter({}, parsed({ "--eye", "1,2,3" })), Rebuild::Nothing);
	EXPECT_EQ(staleAfter({}, parsed({ "--view", "depth" })), Rebuild::Pipelines);
	EXPECT_EQ(staleAfter({}, parsed({ "--view", "depth", "--size", "10x10" })), Rebuild::Buffers);
	EXPECT_EQ(staleAfter(parsed({ "--grid", "2x2" }), parsed({ "--size", "10x10" })), Rebuild::Scene);
	EXPECT_EQ(staleAfter({}, parsed({ "--grid", "2x2", "--validate" })), Rebuild::Device);
}

TEST(commandLine, commandsTakeTheirOwnOptions)
{
	const Result<CommandLine> render = parseCommandLine({ "render", "a.glb", "-o", "b.png", "--stats", "-" });
	ASSERT_TRUE(render);
	EXPECT_EQ(render->command, Command::Render);
	EXPECT_EQ(render->scene, "a.glb");
	EXPECT_EQ(render->output, "b.png");
	EXPECT_EQ(render->stats, "-");
	const Result<CommandLine> exported = parseCommandLine({ "export", "--base", "-o", "b.glb", "a.glb", "--grid", "2x2" });
	ASSERT_TRUE(exported);
	EXPECT_EQ(exported->command, Command::Export);
	EXPECT_TRUE(exported->base);
	EXPECT_EQ(exported->options.grid_rows, 2u);
	const Result<CommandLine> info = parseCommandLine({ "info", "--json", "--print-plan" });
	ASSERT_TRUE(info);
	EXPECT_EQ(info->command, Command::Info);
	EXPECT_TRUE(info->json && info->print_plan && info->scene.empty());
}

TEST(commandLine, wrongUsageNamesTheArgument)
{
	EXPECT_NE(refusal({}).find("render, report, export, info"), std::string::npos);
	EXPECT_NE(refusal({ "draw" }).find("render, report, export, info"), std::string::npos);
	EXPECT_EQ(refusal({ "draw" }).rfind("draw: ", 0), 0u);
	EXPECT_NE(refusal({ "render", "--bogus", "1" }).find("--bogus"), std::string::npos);
	EXPECT_NE(refusal({ "render", "--rate" }).find("--rate"), std::string::npos);
	EXPECT_NE(refusal({ "render", "a.glb", "b.glb" }).find("b.glb"), std::string::npos);
	EXPECT_NE(refusal({ "info", "--stats", "x" }).find("--stats"), std::string::npos);
}

TEST(commandLine, versionAndHelpAreText)
{
	const Result<CommandLine> version = parseCommandLine({ "--version" });
	ASSERT_TRUE(version);
	EXPECT_EQ(version->command, Command::ShowText);
	EXPECT_EQ(version->text.rfind("tessera ", 0), 0u);
	for (const Arguments& arguments : { Arguments{ "--help" }, Arguments{ "render", "--help" }, Arguments{ "export", "-h" } })
	{
		const Result<CommandLine> help = parseCommandLine(arguments);
		ASSERT_TRUE(help);
		EXPECT_EQ(help->command, Command::ShowText);
		EXPECT_NE(help->text.find("builtin:planet"), std::string::npos);
	}
}

}  // namespace tessera::test
