// A device that is lost, at whatever submission: exit code 7, one line that says what was worked on, and no file left behind. The loss comes
// from a layer between the program and the driver (tests/layers/lost_device.cpp).
#include "cpu/program_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace tessera::test
{

namespace
{

// The device is lost at submission `at`, until the end of the scope.
struct LosingAt
{
	explicit LosingAt(int at)
	{
		setenv("VK_LAYER_PATH", TESSERA_TEST_LAYERS, 1);
		setenv("VK_INSTANCE_LAYERS", "VK_LAYER_TESSERA_lost_device", 1);
		setenv("TESSERA_LOSE_AT", std::to_string(at).c_str(), 1);
	}
	~LosingAt()
	{
		for (const char* name : { "VK_LAYER_PATH", "VK_INSTANCE_LAYERS", "TESSERA_LOSE_AT" })
			unsetenv(name);
	}
	LosingAt(const LosingAt&) = delete;
	LosingAt& operator=(const LosingAt&) = delete;
};

std::filesystem::path emptyFolder()
{
	const std::filesystem::path folder = scratchFolder() / "lost";
	std::filesystem::remove_all(folder);
	std::filesystem::create_directories(folder);
	return folder;
}

size_t filesIn(const std::filesystem::path& folder)
{
	return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

class deviceLost : public testing::Test
{
protected:
	void SetUp() override
	{
		const ProgramRun run = runTessera("info");
		if (run.exit_code == 4)
			GTEST_SKIP() << run.errors;
	}
};

}  // namespace

TEST_F(deviceLost, endsWithSevenAndOneLineAndLeavesNoFile)
{
	const std::filesystem::path folder = emptyFolder();
	int at = 0;
	for (; at < 40; ++at)
	{
		const LosingAt scope(at);
		const ProgramRun run =
			runTessera(fmt::format("render builtin:quad --size 64x64 --frames 3 --quiet -o '{0}/p.png' --stats '{0}/s.json'", folder.string()));
		if (run.exit_code == 0)
			break;
		EXPECT_EQ(run.exit_code, 7) << at << ": " << run.errors;
		EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
		EXPECT_NE(run.errors.find("device lost"), std::string::npos) << run.errors;
		EXPECT_NE(run.errors.find("last worked on: "), std::string::npos) << run.errors;
		EXPECT_EQ(filesIn(folder), 0u) << at;
	}
	EXPECT_GE(at, 3) << "an upload, frames and reading back are several submissions";
	EXPECT_LT(at, 40) << "the device was lost whatever was asked";
	EXPECT_EQ(filesIn(folder), 2u);
}

TEST_F(deviceLost, endsOtherCommandsWithSevenToo)
{
	const std::filesystem::path folder = emptyFolder();
	const LosingAt scope(3);
	for (const std::string& command :
		 { fmt::format("export builtin:quad --rate 40 --quiet -o '{}/m.ply'", folder.string()),
		   fmt::format("verify builtin:quad --size 64x48 --cameras 1 --raster soft --quiet --json '{}/v.json'", folder.string()),
		   fmt::format("verify --suite extreme:one_triangle --raster soft --quiet --json '{}/v.json'", folder.string()) })
	{
		const ProgramRun run = runTessera(command);
		EXPECT_EQ(run.exit_code, 7) << command << ": " << run.errors;
		EXPECT_NE(run.errors.find("device lost"), std::string::npos) << run.errors;
		EXPECT_EQ(filesIn(folder), 0u) << command;
	}
}

}  // namespace tessera::test
