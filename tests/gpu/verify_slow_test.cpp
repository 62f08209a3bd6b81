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

TEST(verifySlow, noBackgroundShinesThroughAClosedMeshFromTenThousandPlaces)
{
	expectHolds("builtin:planet --size 160x90 --rate 6 --leaks 10000");
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
