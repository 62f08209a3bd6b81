// The promises of verify on larger scenes and from many cameras: minutes on a software device.
#include "cpu/program_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace tessera::test
{

namespace
{

void expectHolds(const std::string& arguments)
{
	const ProgramRun run = runTessera("verify " + arguments + " --quiet");
	if (run.exit_code == 4)
		GTEST_SKIP() << run.errors;
	EXPECT_EQ(run.exit_code, 0) << run.errors << run.output;
}

struct SlowScene
{
	const char* name;
	const char* scene;  // "bench/..." is a file of the repository
};

void PrintTo(const SlowScene& scene, std::ostream* out)
{
	*out << scene.scene;
}

std::string pathOf(const SlowScene& scene)
{
	const std::string name = scene.scene;
	return name.starts_with("bench/") ? fmt::format("'{}/{}'", TESSERA_SOURCE_ROOT, name) : name;
}

}  // namespace

// Ten thousand are for a GPU: tests/verify_device.sh.
TEST(verifySlow, noBackgroundShinesThroughAClosedMeshFromAThousandPlaces)
{
	expectHolds("builtin:planet --size 160x90 --rate 6 --leaks 1000 --raster soft");
}

// A test per scene, so that they run side by side.
class verifySlowScene : public testing::TestWithParam<SlowScene>
{
};

// Every path, culling on and off, against the double-precision picture and each other: from within the mesh, near it, far off.
TEST_P(verifySlowScene, everyPathSeesTheSameFromFiftyCameras)
{
	expectHolds(pathOf(GetParam()) + " --size 128x72 --rate 4 --cameras 50");
}

TEST_P(verifySlowScene, everyPromiseIsHeld)
{
	expectHolds(pathOf(GetParam()) + " --size 160x90 --rates 16,3 --cameras 8");
}

INSTANTIATE_TEST_SUITE_P(scenes, verifySlowScene,
						 testing::Values(SlowScene{ "sphere", "bench/scenes/sphere.gltf" }, SlowScene{ "terrain", "bench/scenes/terrain.gltf" },
										 SlowScene{ "builtinPlanet", "builtin:planet" }, SlowScene{ "builtinShowcase", "builtin:showcase:60" },
										 SlowScene{ "builtinTerrain", "builtin:terrain" }, SlowScene{ "builtinBricks", "builtin:bricks" },
										 SlowScene{ "builtinInstances", "builtin:instances:60" }, SlowScene{ "builtinQuad", "builtin:quad" },
										 SlowScene{ "builtinCube", "builtin:cube" }, SlowScene{ "builtinMaterials", "builtin:materials" }),
						 [](const auto& made) { return made.param.name; });

}  // namespace tessera::test
