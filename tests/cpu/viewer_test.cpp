// What of the viewer is pure: cameras, command lines, panels, limits, histories, completion.
#include "app/camera_path.h"
#include "app/scene_load.h"
#include "gpu/spirv_constants.h"
#include "scene/build.h"
#include "viewer/camera_control.h"
#include "viewer/completion.h"
#include "viewer/gizmos.h"
#include "viewer/history.h"
#include "viewer/limits.h"
#include "viewer/option_text_form.h"
#include "viewer/panels/panels.h"
#include "viewer/settings.h"
#include "viewer/shader_compiler.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

namespace tessera::view
{

namespace
{

Camera someCamera()
{
	Camera camera;
	camera.eye = { 1.25, 2.5, 4.0 };
	camera.target = { 0.25, 0.5, -0.75 };
	return camera;
}

double distanceOf(const Camera& camera)
{
	return glm::length(camera.target - camera.eye);
}

bool spansView(const Camera& camera)
{
	const dvec3 view = camera.target - camera.eye;
	return glm::length(glm::cross(view, camera.up)) > 1e-6 * glm::length(view) * glm::length(camera.up);
}

ListStats listOf(const char* name, uint64_t wanted, uint32_t capacity)
{
	return { name, wanted, capacity, static_cast<uint32_t>(wanted), static_cast<uint32_t>(std::min<uint64_t>(wanted, capacity)), 0 };
}

// Arguments of a command line whose values are quoted as for a shell.
std::vector<std::string> shellWords(const std::string& line)
{
	std::vector<std::string> words(1);
	bool quoted = false;
	for (size_t i = 0; i < line.size(); ++i)
		if (line[i] == '\'')
			quoted = !quoted;
		else if (line[i] == '\\' && !quoted)
			words.back() += line[++i];
		else if (line[i] == ' ' && !quoted)
			words.emplace_back();
		else
			words.back() += line[i];
	return words;
}

}  // namespace

TEST(cameraControl, orbitsKeepTargetAndDistanceAndNeverLookAlongUp)
{
	Camera camera = someCamera();
	const double distance = distanceOf(camera);
	for (int i = 0; i < 200; ++i)
	{
		camera = orbited(camera, { 0.3, i < 100 ? 0.2 : -0.2 });
		EXPECT_NEAR(distanceOf(camera), distance, 1e-9);
		EXPECT_EQ(camera.target, someCamera().target);
		ASSERT_TRUE(spansView(camera));
	}
}

TEST(cameraControl, turningKeepsTheEye)
{
	Camera camera = someCamera();
	for (int i = 0; i < 100; ++i)
	{
		camera = turned(camera, { 0.1, 0.3 });
		EXPECT_EQ(camera.eye, someCamera().eye);
		ASSERT_TRUE(spansView(camera));
	}
	const Camera right = turned(someCamera(), { 0.1, 0 });
	EXPECT_GT(pixelOf(someCamera(), right.target, { 100, 100 }).x, 50.0) << "positive x turns to the right";
}

TEST(cameraControl, panningMovesTheTargetWithTheMouse)
{
	const uvec2 size = { 640, 360 };
	for (bool orthographic : { false, true })
	{
		Camera camera = someCamera();
		camera.orthographic = orthographic;
		const dvec3 target = camera.target;
		const dvec3 pixel = pixelOf(panned(camera, { 40, -25 }, size.y), target, size);
		EXPECT_NEAR(pixel.x, 320 + 40, 1e-6);
		EXPECT_NEAR(pixel.y, 180 - 25, 1e-6);
	}
}

TEST(cameraControl, pointsAndPixelsAreInverse)
{
	const uvec2 size = { 320, 240 };
	for (bool orthographic : { false, true })
	{
		Camera camera = someCamera();
		camera.orthographic = orthographic;
		const dvec3 found = pixelOf(camera, pointAt(camera, { 17.5, 201.25 }, size, 3.5), size);
		EXPECT_NEAR(found.x, 17.5, 1e-9);
		EXPECT_NEAR(found.y, 201.25, 1e-9);
		EXPECT_NEAR(found.z, 3.5, 1e-9);
	}
}

TEST(cameraControl, framingShowsTheWholeSphereAndTouchesTheEdge)
{
	for (double aspect : { 0.5, 1.0, 2.0 })
	{
		const Camera camera = framing(someCamera(), { 1, 2, 3 }, 2, aspect);
		const double half = camera.fov_y_rad / 2, narrow = std::atan(std::tan(half) * std::min(1.0, aspect));
		EXPECT_NEAR(std::asin(2 / distanceOf(camera)), narrow, 1e-9);
		EXPECT_EQ(camera.target, dvec3(1, 2, 3));
	}
}

TEST(cameraControl, dollyStepsAreUndoneByStepsBack)
{
	const Camera camera = dollied(dollied(someCamera(), 5), -5);
	EXPECT_NEAR(glm::length(camera.eye - someCamera().eye), 0, 1e-12);
	EXPECT_LT(distanceOf(dollied(someCamera(), 1)), distanceOf(someCamera()));
}

TEST(cameraPath, readsBackBitForBitAndPassesThroughItsKeys)
{
	CameraPath path;
	for (int i = 0; i < 5; ++i)
	{
		Camera camera = withFov(orbited(someCamera(), { 0.37 * i, 0.11 * i }), 40 + i * 1.7);
		camera.near_world = i * 0.01;
		camera.orthographic = i == 4;
		path.keys.push_back({ i * 0.7, camera });
	}
	const auto file = std::filesystem::temp_directory_path() / ("tessera_path_" + std::to_string(std::rand()) + ".json");
	std::ofstream(file) << cameraPathText(path);
	const auto read = readCameraPath(file);
	std::filesystem::remove(file);
	ASSERT_TRUE(read.has_value()) << read.error().message;
	ASSERT_EQ(read->keys.size(), path.keys.size());
	for (size_t i = 0; i < path.keys.size(); ++i)
	{
		Camera expected = path.keys[i].camera;
		expected.height_world = expected.orthographic ? expected.height_world : read->keys[i].camera.height_world;
		EXPECT_EQ(read->keys[i].time_s, path.keys[i].time_s);
		EXPECT_EQ(read->keys[i].camera, expected) << i;
		EXPECT_EQ(path.at(path.keys[i].time_s), path.keys[i].camera) << i;
	}
	EXPECT_EQ(path.at(-1), path.keys.front().camera);
	EXPECT_EQ(path.at(99), path.keys.back().camera);
	const Camera middle = path.at(0.35);
	EXPECT_NEAR(glm::length(middle.eye - (path.keys[0].camera.eye + path.keys[1].camera.eye) / 2.0), 0, 1e-12);
}

TEST(cameraPath, refusesWhatIsNoPathWithThePlace)
{
	const auto file = std::filesystem::temp_directory_path() / ("tessera_path_" + std::to_string(std::rand()) + ".json");
	const char* good = R"({"time_s": 0, "eye": [0,0,3], "target": [0,0,0], "up": [0,1,0]})";
	const std::pair<std::string, const char*> wrong[] = {
		{ "", "camera path" },
		{ "[]", "camera path" },
		{ R"({"keys": []})", "camera path" },
		{ R"({"keys": [1]})", "key 0" },
		{ R"({"keys": [{"time_s": 1, "eye": [0,0,3], "target": [0,0,0], "up": [0,1,0]}]})", "start at 0" },
		{ std::string(R"({"keys": [)") + good + "," + good + "]}", "key 1: times" },
		{ R"({"keys": [{"time_s": 0, "eye": [0,0,3], "target": [0,0,3], "up": [0,1,0]}]})", "differ" },
		{ R"({"keys": [{"time_s": 0, "eye": [0,0,3], "target": [0,0,0], "up": [0,0,1]}]})", "along" },
		{ R"({"keys": [{"time_s": 0, "eye": [0,0,"3"], "target": [0,0,0], "up": [0,1,0]}]})", "three finite" },
		{ R"({"keys": [{"time_s": 0, "eye": [0,0,3], "target": [0,0,0], "up": [0,1,0], "fov_deg": 180}]})", "fov_deg" },
	};
	for (const auto& [text, message] : wrong)
	{
		std::ofstream(file) << text;
		const auto read = readCameraPath(file);
		ASSERT_FALSE(read.has_value()) << text;
		EXPECT_NE(read.error().message.find(message), std::string::npos) << read.error().message;
	}
	std::filesystem::remove(file);
	EXPECT_FALSE(readCameraPath(file).has_value());
}

TEST(renderCommandLine, readsBackAsTheSameOptionsAndCameraBits)
{
	const auto imported = importScene("builtin:quad", {});
	ASSERT_TRUE(imported.has_value());
	const auto scene = buildScene(*imported);
	ASSERT_TRUE(scene.has_value());
	AppOptions options;
	for (const auto& [name, value] : std::initializer_list<std::pair<const char*, const char*>>{ { "rate", "2.7" },
																								 { "cull", "frustum" },
																								 { "capacity", "part_triangles=1234" },
																								 { "view", "factors" },
																								 { "size", "333x222" },
																								 { "budget", "3MB" } })
		ASSERT_TRUE(setOption(*findOption(name), value, options).has_value()) << name;
	for (double step : { 0.0, 0.1, 1.7, 3.3 })
	{
		Camera camera = withFov(orbited(someCamera(), { step, step / 7 }), 37 + step);
		camera.near_world = step / 10;
		camera.orthographic = step > 3;
		const std::vector<std::string> words = shellWords(renderCommandLine("a scene's file.gltf", options, camera));
		ASSERT_EQ(words[2], "a scene's file.gltf");
		AppOptions read;
		for (size_t i = 3; i < words.size(); ++i)
		{
			const size_t equals = words[i].find('=');
			const OptionDesc* option = findOption(words[i].substr(2, equals - 2));
			ASSERT_NE(option, nullptr) << words[i];
			ASSERT_TRUE(setOption(*option, equals == std::string::npos ? "" : words[i].substr(equals + 1), read).has_value()) << words[i];
		}
		const auto found = chooseCamera(*scene, read);
		ASSERT_TRUE(found.has_value());
		EXPECT_EQ(found->eye, camera.eye);
		EXPECT_EQ(found->target, camera.target);
		EXPECT_EQ(found->up, camera.up);
		EXPECT_EQ(found->orthographic, camera.orthographic);
		EXPECT_EQ(camera.orthographic ? found->height_world : found->fov_y_rad, camera.orthographic ? camera.height_world : camera.fov_y_rad);
		EXPECT_EQ(optionsJson(read), optionsJson(withCamera(options, camera)));
	}
}

TEST(withOption, noValueIsTheDefaultAndTheOthersStay)
{
	AppOptions options;
	for (const auto& [name, value] :
		 std::initializer_list<std::pair<const char*, const char*>>{ { "rate", "2" }, { "budget", "3MB" }, { "grid-u", "1,2,3" } })
		ASSERT_TRUE(setOption(*findOption(name), value, options).has_value());
	for (const char* name : { "rate", "budget", "grid-u" })
	{
		const auto changed = withOption(*findOption(name), {}, options);
		ASSERT_TRUE(changed.has_value());
		AppOptions expected;
		for (const char* other : { "rate", "budget", "grid-u" })
			if (other != std::string(name))
			{
				ASSERT_TRUE(setOption(*findOption(other), printOption(*findOption(other), options)[0], expected).has_value());
			}
		EXPECT_EQ(optionsJson(*changed), optionsJson(expected)) << name;
	}
	EXPECT_FALSE(withOption(*findOption("rate"), { "fast" }, options).has_value());
}

TEST(panels, everyRowOfTheOptionTableHasExactlyOnePlace)
{
	std::multiset<std::string_view> places(optionsWithoutPanel().begin(), optionsWithoutPanel().end());
	for (const Panel& panel : panels())
		places.insert(panel.options.begin(), panel.options.end());
	for (const OptionDesc& option : optionTable())
		EXPECT_EQ(places.count(option.name), 1u) << option.name;
	for (std::string_view name : places)
		EXPECT_NE(findOption(name), nullptr) << name;
}

TEST(limits, areColouredFromEightyPercentAndAboveAll)
{
	EXPECT_EQ(fillOf(0, 0), Fill::Roomy);
	EXPECT_EQ(fillOf(79, 100), Fill::Roomy);
	EXPECT_EQ(fillOf(80, 100), Fill::Tight);
	EXPECT_EQ(fillOf(100, 100), Fill::Tight);
	EXPECT_EQ(fillOf(101, 100), Fill::Full);
	EXPECT_EQ(fillOf(5000000000, 0xffffffff), Fill::Full);
}

TEST(limits, highWaterIsTheMostThatWasEverWantedAndFitHoldsIt)
{
	HighWater marks;
	const std::vector<ListStats> first = { listOf("part_triangles", 900, 1000), listOf("batches", 50, 60) };
	const std::vector<ListStats> second = { listOf("part_triangles", 300, 1000), listOf("visible_clusters", 2, 64) };
	marks.add(first);
	marks.add(second);
	EXPECT_EQ(marks.of("part_triangles"), 900u);
	EXPECT_EQ(marks.of("no list"), 0u);
	const auto capacities = marks.fittingCapacities();
	EXPECT_GE(capacities.at("part_triangles"), 900u);
	EXPECT_LE(capacities.at("part_triangles"), 1100u);
	EXPECT_EQ(capacities.count("batches"), 0u) << "batches follow from parts";
	AppOptions options;
	for (const auto& [name, count] : capacities)
		EXPECT_TRUE(setOption(*findOption("capacity"), name + "=" + std::to_string(count), options).has_value()) << name;
	marks.clear();
	EXPECT_EQ(marks.of("part_triangles"), 0u);
}

TEST(limits, aFrameThatIsAsFineAsAskedForHasNoWarning)
{
	FrameResult result;
	result.rate_wanted = result.rate_granted = 4;
	EXPECT_EQ(coarseningWarning(result), "");
	result.coarsening = 16;
	result.rate_granted = 8;
	result.lists = { listOf("part_triangles", 900, 100), listOf("batches", 5, 60) };
	const std::string warning = coarseningWarning(result);
	EXPECT_NE(warning.find("4 px wanted, 8 px granted"), std::string::npos) << warning;
	EXPECT_NE(warning.find("part_triangles"), std::string::npos) << warning;
	EXPECT_EQ(warning.find("batches"), std::string::npos) << warning;
}

TEST(history, medianIsOfTheLastSecondAndOldValuesGo)
{
	History history(10);
	EXPECT_EQ(history.median(), 0);
	for (int i = 0; i < 100; ++i)
		history.add(i * 0.25, i);
	EXPECT_EQ(history.median(1), 97) << "of 95, 96, 97, 98, 99";
	EXPECT_EQ(history.median(0.25), 98.5);
	EXPECT_EQ(history.values().size(), 41u);
	EXPECT_EQ(history.values().front(), 59.0f);
}

TEST(completion, goesOnAsFarAsItIsCertain)
{
	namespace fs = std::filesystem;
	const fs::path folder = fs::temp_directory_path() / ("tessera_completion_" + std::to_string(std::rand()));
	fs::create_directories(folder / "models");
	for (const char* name : { "sphere.gltf", "sphere_two.GLB", "sphere.png", ".hidden.glb" })
		std::ofstream(folder / name) << "x";
	const std::string base = folder.string() + "/";
	const std::vector<std::string> suffixes = { ".gltf", ".glb" };
	const Completion spheres = completePath(base + "sp", suffixes);
	EXPECT_EQ(spheres.text, base + "sphere");
	EXPECT_EQ(spheres.files, (std::vector<std::string>{ base + "sphere.gltf", base + "sphere_two.GLB" }));
	EXPECT_EQ(completePath(base + "m", suffixes).text, base + "models/");
	EXPECT_EQ(completePath(base + "x", suffixes).text, base + "x");
	EXPECT_TRUE(completePath(base + "x", suffixes).files.empty());
	EXPECT_EQ(completePath(base + ".h", suffixes).text, base + ".hidden.glb");
	EXPECT_EQ(completePath(base, suffixes).files.size(), 3u) << "hidden files stay hidden";
	EXPECT_EQ(completePath("built", suffixes, { "builtin:planet", "builtin:cube" }).text, "builtin:");
	EXPECT_TRUE(completePath(base + "no/such/folder", suffixes).files.empty());
	fs::remove_all(folder);
}

TEST(gizmos, linesAreCutAtTheNearDistance)
{
	const uvec2 size = { 400, 300 };
	const Camera camera = someCamera();
	const dvec3 forward = glm::normalize(camera.target - camera.eye);
	const dvec3 before = camera.eye + forward * 2.0, behind = camera.eye - forward * 2.0 + dvec3(0.3, 0.1, 0);
	EXPECT_FALSE(pixelLine(camera, behind, behind + dvec3(1, 0, 0), 0.01, size).has_value());
	const auto whole = pixelLine(camera, before, before + dvec3(0.1, 0, 0), 0.01, size);
	ASSERT_TRUE(whole.has_value());
	EXPECT_NEAR(whole->from.x, 200, 1e-9);
	EXPECT_NEAR(whole->from.y, 150, 1e-9);
	for (bool turned_round : { false, true })
	{
		const auto cut = turned_round ? pixelLine(camera, behind, before, 0.01, size) : pixelLine(camera, before, behind, 0.01, size);
		ASSERT_TRUE(cut.has_value());
		const double depth = glm::dot(behind - camera.eye, forward);
		const dvec3 end = glm::mix(before, behind, (2 - 0.01) / (2 - depth));  // where the line meets the near plane
		EXPECT_NEAR(glm::length((turned_round ? cut->from : cut->to) - dvec2(pixelOf(camera, end, size))), 0, 1e-3);
		EXPECT_TRUE(std::isfinite(cut->to.x) && std::isfinite(cut->from.x));
	}
}

TEST(gizmos, frustumCornersLieOnTheCornersOfThePicture)
{
	const uvec2 size = { 400, 200 };
	for (bool orthographic : { false, true })
	{
		Camera camera = someCamera();
		camera.orthographic = orthographic;
		const auto corners = frustumCorners(camera, 0.5, 7, 2);
		for (size_t i = 0; i < corners.size(); ++i)
		{
			const dvec3 pixel = pixelOf(camera, corners[i], size);
			EXPECT_NEAR(pixel.x, i & 1 ? 400 : 0, 1e-6);
			EXPECT_NEAR(pixel.y, i & 2 ? 0 : 200, 1e-6);
			EXPECT_NEAR(pixel.z, i & 4 ? 7 : 0.5, 1e-9);
		}
	}
}

TEST(settings, areReadBackAndWhatIsWrongIsLeftAlone)
{
	Session session;
	session.vsync = false;
	session.typed_path = "a/b.gltf";
	session.gizmos.cones = true;
	session.open_panels = { { "Plan", true }, { "Log", false }, { "Raster", true } };
	const auto json = settingsJson(session, { 900, 500 });
	Session read;
	EXPECT_EQ(applySettings(json, read), uvec2(900, 500));
	EXPECT_EQ(settingsJson(read, { 900, 500 }), json);
	EXPECT_TRUE(read.open_panels["Plan"] && read.open_panels["Raster"]);
	EXPECT_FALSE(read.open_panels["Log"]);
	for (const char* text : { "null", "[]", "{}", R"({"window": [1, 2]})", R"({"window": [-900, 500]})", R"({"window": "big"})",
							  R"({"vsync": 3, "panels": 7, "gizmos": []})", R"({"panels": ["no such panel"]})" })
	{
		Session untouched;
		EXPECT_EQ(applySettings(nlohmann::ordered_json::parse(text), untouched), uvec2(0)) << text;
		EXPECT_TRUE(untouched.vsync);
		for (const auto& [name, open] : untouched.open_panels)
			EXPECT_FALSE(open) << text;
	}
}

TEST(shaderReload, givesTheSameCodeAsTheBuildAndFindsErrors)
{
	const std::filesystem::path sources = TESSERA_SOURCE_ROOT "/shaders";
	for (const char* name : { "shading/shade.comp", "culling/cluster_cull.comp", "raster/draw_batches.mesh", "raster/draw_indexed.frag" })
	{
		const auto compiled = compileShader(sources, name);
		ASSERT_TRUE(compiled.has_value()) << compiled.error().message;
		const auto built = loadShader(name);
		ASSERT_TRUE(built.has_value()) << built.error().message;
		EXPECT_EQ(compiled->stage, built->stage);
		EXPECT_EQ(compiled->words == built->words, true) << name << ": pipelines would be replaced without need";
	}
	const auto folder = std::filesystem::temp_directory_path() / ("tessera_shader_" + std::to_string(std::rand()));
	std::filesystem::create_directories(folder / "room");
	std::ofstream(folder / "room/wrong.comp") << "#version 460\nlayout(local_size_x = 1) in;\nvoid main() { nonsense; }\n";
	const auto wrong = compileShader(folder, "room/wrong.comp");
	ASSERT_FALSE(wrong.has_value());
	EXPECT_NE(wrong.error().message.find("room/wrong.comp:3"), std::string::npos) << wrong.error().message;
	EXPECT_FALSE(compileShader(folder, "room/missing.comp").has_value());
	std::filesystem::remove_all(folder);
}

TEST(shaderReload, noticesThatASourceHasChanged)
{
	const auto folder = std::filesystem::temp_directory_path() / ("tessera_watch_" + std::to_string(std::rand()));
	std::filesystem::create_directories(folder / "room");
	std::ofstream(folder / "room/a.comp") << "1";
	ShaderReloader reloader(folder);
	EXPECT_FALSE(reloader.sourcesChanged(0)) << "the first look only remembers";
	EXPECT_FALSE(reloader.sourcesChanged(2));
	std::filesystem::last_write_time(folder / "room/a.comp", std::filesystem::file_time_type::clock::now() + std::chrono::seconds(5));
	EXPECT_FALSE(reloader.sourcesChanged(2.5)) << "looks at most once a second";
	EXPECT_TRUE(reloader.sourcesChanged(4));
	EXPECT_FALSE(reloader.sourcesChanged(6));
	std::filesystem::remove_all(folder);
}

TEST(usedConstants, areThoseThatTheCodeRefersTo)
{
	const auto shade = loadShader("shading/shade.comp"), begin = loadShader("culling/frame_begin.comp");
	ASSERT_TRUE(shade.has_value() && begin.has_value());
	const std::set<uint32_t> used = usedConstants(shade->words);
	EXPECT_TRUE(used.count(11)) << "IS_SHADED_VIEW";
	EXPECT_TRUE(used.count(14)) << "READS_BUFFER";
	EXPECT_FALSE(used.count(12)) << "KEEPS_VERTICES belongs to the rasterisers";
	EXPECT_TRUE(usedConstants(begin->words).empty());
	EXPECT_TRUE(usedConstants({}).empty());
	EXPECT_NO_FATAL_FAILURE(usedConstants(std::span(shade->words).first(shade->words.size() / 2)));
}

}  // namespace tessera::view
