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

}  // namespace

// Ten thousand are for a GPU: tests/verify_device.sh.
TEST(verifySlow, noBackgroundShinesThroughAClosedMeshFromAThousandPlaces)
{
	expectHolds("builtin:planet --size 160x90 --rate 6 --leaks 1000 --raster soft");
}

// Every path, culling on and off, against the double-precision picture and each other: from within the mesh, near it, far off.
TEST(verifySlow, everyPathSeesTheSameFromFiftyCamerasOfEveryScene)
{
	const std::string bench = fmt::format("'{}/bench/scenes/", TESSERA_SOURCE_ROOT);
	std::vector<std::string> scenes = { bench + "sphere.gltf'", bench + "terrain.gltf'" };
	for (const char* name : { "planet", "showcase:60", "terrain", "bricks", "instances:60", "quad", "cube", "materials" })
		scenes.push_back(fmt::format("builtin:{}", name));
	for (const std::string& scene : scenes)
		expectHolds(scene + " --size 128x72 --rate 4 --cameras 50");
}

TEST(verifySlow, everyBuiltInSceneHoldsEveryPromise)
{
	for (const char* scene : { "planet", "showcase:60", "terrain", "bricks", "instances:200", "quad", "cube", "materials" })
		expectHolds(std::string("builtin:") + scene + " --size 320x180 --rates 16,4,1.5 --cameras 12");
}

TEST(verifySlow, everySceneOfTheBenchHoldsEveryPromise)
{
	for (const char* scene : { "sphere", "terrain" })
		expectHolds(fmt::format("'{}/bench/scenes/{}.gltf' --size 320x180 --rates 16,4,1.5 --cameras 12", TESSERA_SOURCE_ROOT, scene));
}

}  // namespace tessera::test
