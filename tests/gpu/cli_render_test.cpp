// The program with a device: pictures, stats, plans, and the exit codes that only drawing leads to.
#include "cpu/program_run.h"
#include "frame/lists.h"
#include "pipeline/passes.h"

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tessera::test
{

namespace
{

using nlohmann::json;

class programWithDevice : public testing::Test
{
protected:
	void SetUp() override
	{
		const ProgramRun run = runTessera("info");
		if (run.exit_code == 4)
			GTEST_SKIP() << run.errors;
	}
};

json statsOf(const std::string& arguments)
{
	const ProgramRun run = runTessera("render " + arguments + " --stats - --quiet");
	EXPECT_EQ(run.exit_code, 0) << run.errors;
	return json::parse(run.output, nullptr, false);
}

}  // namespace

TEST_F(programWithDevice, statsHaveEveryPromisedKey)
{
	const json stats = statsOf("builtin:quad --size 160x120 --rate 8 --frames 3 --warmup 1");
	ASSERT_TRUE(stats.is_object());
	EXPECT_EQ(stats["schema"], 1);
	for (const char* key : { "name", "driver", "api", "gates" })
		EXPECT_TRUE(stats["device"].contains(key)) << key;
	EXPECT_TRUE(stats["device"]["gates"]["mesh_shader"].is_boolean());
	EXPECT_EQ(stats["scene"]["path"], "builtin:quad");
	EXPECT_EQ(stats["scene"]["base_triangles"], 2);
	EXPECT_EQ(stats["scene"]["instances"], 1);
	EXPECT_EQ(stats["scene"]["clusters"], 1);
	EXPECT_EQ(stats["options"]["rate"], 8.0);
	EXPECT_EQ(stats["options"]["size"], json({ 160, 120 }));
	const json& frame = stats["frame"];
	EXPECT_EQ(frame["frames"], 3);
	EXPECT_LE(frame["gpu_ms"]["min"], frame["gpu_ms"]["median"]);
	EXPECT_LE(frame["gpu_ms"]["median"], frame["gpu_ms"]["max"]);
	EXPECT_EQ(frame["rate_wanted"], 8.0);
	EXPECT_EQ(frame["rate_granted"], 8.0);
	for (const char* key : { "full_clusters", "part_triangles", "split_triangles", "micro_triangles", "covered_pixels" })
		EXPECT_TRUE(frame[key].is_number_unsigned()) << key;
	EXPECT_GT(frame["covered_pixels"], 0u);
	const json& memory = stats["memory"];
	EXPECT_EQ(memory["total"].get<uint64_t>(), memory["lists"].get<uint64_t>() + memory["geometry"].get<uint64_t>() +
												   memory["textures"].get<uint64_t>() + memory["images"].get<uint64_t>());
}

TEST_F(programWithDevice, everyPassHasATimeOrAReason)
{
	const json stats = statsOf("builtin:quad --size 64x64");
	EXPECT_EQ(stats["passes"].size(), framePasses().size());
	for (const auto& [name, pass] : stats["passes"].items())
		EXPECT_TRUE((pass.contains("gpu_ms") && pass["gpu_ms"].contains("median")) || !pass.value("dropped", "").empty()) << name;
	for (const char* list : { "visible_clusters", "full_clusters", "part_triangles" })
		for (const char* key : { "wanted", "capacity", "peak", "peak_used", "bytes" })
			EXPECT_TRUE(stats["lists"][list].contains(key)) << list << " " << key;
}

TEST_F(programWithDevice, aListThatIsTooSmallCoarsensAndStrictRefusesThat)
{
	const std::string tight = "builtin:quad --size 96x64 --rate 0.5 --capacity part_triangles=20";
	const json stats = statsOf(tight);
	EXPECT_GT(stats["frame"]["rate_granted"], stats["frame"]["rate_wanted"]);
	EXPECT_LE(stats["lists"]["part_triangles"]["wanted"], 20u);
	const ProgramRun warned = runTessera("render " + tight + " --quiet");
	EXPECT_EQ(warned.exit_code, 0);
	EXPECT_NE(warned.errors.find("warning: the rate was coarsened"), std::string::npos) << warned.errors;
	EXPECT_NE(warned.errors.find("part_triangles"), std::string::npos) << warned.errors;
	const ProgramRun strict = runTessera("render " + tight + " --strict -o strict.png --stats strict.json");
	EXPECT_EQ(strict.exit_code, 5);
	EXPECT_FALSE(std::filesystem::exists(scratchFolder() / "strict.png"));
	EXPECT_FALSE(std::filesystem::exists(scratchFolder() / "strict.json"));
}

TEST_F(programWithDevice, aBudgetIsKeptOrRefused)
{
	const json stats = statsOf("builtin:quad --size 96x64 --rate 0.5 --budget 300kB");
	EXPECT_LE(stats["memory"]["lists"], 300'000u);
	EXPECT_EQ(stats["options"]["budget"], 300'000u);
	for (const char* command : { "render builtin:quad --budget 1kB -o small.png", "info builtin:quad --print-plan --budget 1kB" })
	{
		const ProgramRun run = runTessera(command);
		EXPECT_EQ(run.exit_code, 2) << command;
		EXPECT_NE(run.errors.find("--budget: 1000 bytes are too few"), std::string::npos) << run.errors;
	}
	EXPECT_FALSE(std::filesystem::exists(scratchFolder() / "small.png"));
}

TEST_F(programWithDevice, everyViewIsDrawn)
{
	for (const char* view :
		 { "shaded", "clusters", "parts", "triangles", "factors", "depth", "normals", "wireframe", "facets", "height", "instances", "materials" })
	{
		const std::string picture = fmt::format("{}.png", view);
		EXPECT_EQ(runTessera(fmt::format("render builtin:quad --size 64x64 --view {} -o {}", view, picture)).exit_code, 0);
		EXPECT_TRUE(std::filesystem::exists(scratchFolder() / picture)) << view;
	}
}

TEST_F(programWithDevice, theValidationLayerHasNothingToSay)
{
	const ProgramRun run = runTessera("render builtin:bricks --size 96x64 --rate 2 --validate --quiet");
	if (run.exit_code == 4)
		GTEST_SKIP() << run.errors;
	EXPECT_EQ(run.exit_code, 0) << run.errors;
}

TEST_F(programWithDevice, infoPrintsDeviceSceneAndPlan)
{
	const ProgramRun run = runTessera("info builtin:quad --print-plan --json");
	ASSERT_EQ(run.exit_code, 0) << run.errors;
	const json info = json::parse(run.output, nullptr, false);
	ASSERT_TRUE(info.is_object());
	EXPECT_GT(info["plan"]["passes"].size(), 3u);
	EXPECT_GT(info["plan"]["bytes_saved"], 0u);
	EXPECT_EQ(info["plan"]["passes"].size() + info["plan"]["dropped"].size(), framePasses().size());
	const ProgramRun text = runTessera("info builtin:quad --print-plan");
	EXPECT_NE(text.output.find("mesh_shader"), std::string::npos);
	EXPECT_NE(text.output.find("passes left out"), std::string::npos);
	EXPECT_NE(text.output.find("shade"), std::string::npos);
}

TEST_F(programWithDevice, aCameraPathGivesThePicturesOfItsCameras)
{
	const std::filesystem::path folder = scratchFolder() / "path";
	std::filesystem::create_directories(folder);
	std::ofstream(folder / "path.json") << R"({"keys": [
		{"time_s": 0, "eye": [0, 1, 3], "target": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 50},
		{"time_s": 2, "eye": [3, 1, 0], "target": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 50}]})";
	const auto textOf = [](const std::filesystem::path& file) {
		std::ifstream stream(file, std::ios::binary);
		return std::string(std::istreambuf_iterator<char>(stream), {});
	};
	const std::string scene = "render builtin:cube --size 64x48 --rate 8 --quiet ";
	const ProgramRun run =
		runTessera(scene + "--frames 3 --camera-path " + (folder / "path.json").string() + " -o " + (folder / "f_##.png").string());
	ASSERT_EQ(run.exit_code, 0) << run.errors;
	const std::pair<const char*, const char*> expected[] = { { "f_00.png", "0,1,3" }, { "f_01.png", "1.5,1,1.5" }, { "f_02.png", "3,1,0" } };
	for (const auto& [name, eye] : expected)
	{
		const std::string one = (folder / "one.png").string();
		ASSERT_EQ(runTessera(scene + "--fov 50 --target 0,0,0 --up 0,1,0 --eye " + eye + " -o " + one).exit_code, 0);
		EXPECT_FALSE(textOf(one).empty());
		EXPECT_EQ(textOf(folder / name) == textOf(one), true) << name;
	}
	EXPECT_EQ(runTessera(scene + "--camera-path " + (folder / "none.json").string()).exit_code, 3);
}

TEST_F(programWithDevice, clustersThatTheDeviceLacksEndWithFourAndTheReason)
{
	const json info = json::parse(runTessera("info --json").output, nullptr, false);
	if (info["device"]["gates"]["cluster_acceleration_structure"])
		GTEST_SKIP() << "the device has them";
	const std::string why = info["device"]["why_closed"]["cluster_acceleration_structure"];
	EXPECT_FALSE(why.empty());
	const ProgramRun run = runTessera("render builtin:quad --raster rt --rays clusters --size 16x16 -o " + (scratchFolder() / "no.png").string());
	EXPECT_EQ(run.exit_code, 4) << run.errors;
	EXPECT_NE(run.errors.find(why), std::string::npos) << run.errors;
	// Without being asked for, the other way is taken, and said.
	const json rays = info["device"]["gates"]["ray_tracing_pipeline"] ? statsOf("builtin:quad --raster rt --size 32x32")["rays"] : json();
	if (rays.is_object())
	{
		EXPECT_EQ(rays["path"], "khr");
		EXPECT_EQ(rays["path_reason"], why);
	}
}

#ifdef TESSERA_CLUSTER_LAYERS

// Under the layer that emulates clusters: every promised key, and the counts of all four kinds.
TEST_F(programWithDevice, raysThroughClustersSayWhatTheyAreMadeOf)
{
	setenv("VK_INSTANCE_LAYERS", "VK_LAYER_TESSERA_cluster_emulation", 1);
	setenv("VK_ADD_LAYER_PATH", TESSERA_CLUSTER_LAYERS, 1);
	setenv("TESSERA_CLUSTER_LAYER_ABORT", "1", 1);
	const json info = json::parse(runTessera("info --json").output, nullptr, false);
	const bool traces = info["device"]["gates"]["ray_tracing_pipeline"];
	const json stats = traces ? statsOf("builtin:bricks --raster rt --rate 6 --size 160x90") : json();
	unsetenv("VK_INSTANCE_LAYERS");
	if (!traces)
		GTEST_SKIP() << "the device cannot trace rays";
	EXPECT_EQ(info["device"]["gates"]["cluster_acceleration_structure"], true);
	const json& rays = stats["rays"];
	EXPECT_EQ(rays["path"], "clusters");
	EXPECT_TRUE(rays["path_reason"].is_string());
	for (const char* key : { "templates", "template_instantiations", "full_clusters", "part_triangles", "transient_1x1x1", "transient_2x2x2",
							 "structures", "generated_vertices", "template_bytes", "cluster_bytes", "cluster_used_bytes", "structure_bytes",
							 "structure_used_bytes", "operation_bytes", "scene_bytes" })
		EXPECT_GT(rays.value(key, 0u), 0u) << key;
	EXPECT_EQ(rays["template_instantiations"], rays["full_clusters"].get<uint64_t>() + rays["part_triangles"].get<uint64_t>());
	EXPECT_LE(rays["cluster_used_bytes"], rays["cluster_bytes"]);
	EXPECT_LE(rays["structure_used_bytes"], rays["structure_bytes"]);
	for (const char* list : { "ray_instantiations", "ray_instantiated_triangles", "ray_instantiated_vertices", "ray_transients",
							  "ray_transient_triangles", "ray_transient_vertices", "ray_cluster_units", "ray_largest_structure" })
	{
		EXPECT_GT(stats["lists"][list].value("wanted", 0u), 0u) << list;
		EXPECT_LE(stats["lists"][list].value("wanted", 0u), stats["lists"][list].value("capacity", 0u)) << list;
	}
	EXPECT_GE(stats["memory"]["rays"], rays["cluster_bytes"].get<uint64_t>() + rays["template_bytes"].get<uint64_t>());
}

#endif

TEST_F(programWithDevice, anUnknownDeviceEndsWithFour)
{
	const ProgramRun run = runTessera("render builtin:quad --device no-such-device --quiet");
	EXPECT_EQ(run.exit_code, 4);
	EXPECT_NE(run.errors.find("--device no-such-device"), std::string::npos);
}

}  // namespace tessera::test
