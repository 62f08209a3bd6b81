// The promises of verify on larger scenes and from many cameras: minutes on a software device.
#include "cpu/program_run.h"

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

TEST(verifySlow, noBackgroundShinesThroughAClosedMeshFromTwoHundredPlaces)
{
	expectHolds("builtin:planet --raster soft --size 320x180 --rate 4 --cameras 200 --seed 2");
}

TEST(verifySlow, everyBuiltInSceneHoldsEveryPromise)
{
	for (const char* scene : { "planet", "showcase:60", "terrain", "bricks", "instances:200", "quad", "cube", "materials" })
		expectHolds(std::string("builtin:") + scene + " --size 320x180 --rates 16,4,1.5 --cameras 12");
}

}  // namespace tessera::test
