// Out of memory on the host: one line, wherever it happens.
#include "base/parallel.h"
#include "gltf_file.h"
#include "scene/build.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>

namespace tessera
{

namespace
{

// Address space that this process has now, in bytes.
size_t addressSpace()
{
	size_t pages = 0;
	std::ifstream("/proc/self/statm") >> pages;
	return pages * size_t(sysconf(_SC_PAGESIZE));
}

// A small file that says it has 60 meshes of four million vertices.
GltfFile hugeFile()
{
	GltfFile file;
	file.json["accessors"].push_back({ { "componentType", 5126 }, { "type", "VEC3" }, { "count", 1 << 22 } });
	for (int i = 0; i < 60; ++i)
		file.addPrimitive({ { "POSITION", 0 } });
	return file;
}

enum Outcome : int
{
	kLoaded = 0,
	kRefused = 3,
	kWrongError = 40,
	kThrew = 41,
};

// Imports and builds with `room` bytes of address space more than now, in a process of its own; how that ended.
int outcomeWith(size_t room, const std::filesystem::path& path)
{
	const pid_t child = fork();
	if (child == 0)
	{
		const rlimit limit = { addressSpace() + room, addressSpace() + room };
		setrlimit(RLIMIT_AS, &limit);
		try
		{
			const Result<ImportedScene> imported = importGltf(path);
			if (!imported)
				_exit(imported.error().code == ExitCode::BadInput && imported.error().message.find('\n') == std::string::npos ? kRefused
																															  : kWrongError);
			_exit(buildScene(*imported) ? kLoaded : kWrongError);
		}
		catch (const std::bad_alloc&)
		{
			_exit(kRefused);  // runProgram makes exit code 3 of it
		}
		catch (...)
		{
			_exit(kThrew);
		}
	}
	int status = 0;
	waitpid(child, &status, 0);
	return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

bool hasSanitizers()
{
#if defined(__SANITIZE_ADDRESS__)
	return true;
#elif defined(__has_feature)
	return __has_feature(address_sanitizer);
#else
	return false;
#endif
}

}  // namespace

TEST(outOfMemory, aFileThatAsksForTooMuchIsRefusedInOneLine)
{
	if (hasSanitizers())
		GTEST_SKIP() << "address sanitizers need more address space than can be limited";
	const TemporaryFolder folder;
	const std::filesystem::path path = hugeFile().write(folder.path);
	for (const size_t megabytes : { 1, 40, 300 })
		EXPECT_EQ(outcomeWith(megabytes << 20, path), kRefused) << megabytes << " MB";
}

TEST(outOfMemory, whateverIsTheLastThatFitsTheRestIsRefused)
{
	if (hasSanitizers())
		GTEST_SKIP() << "address sanitizers need more address space than can be limited";
	const TemporaryFolder folder;
	GltfFile file;
	file.json["accessors"].push_back({ { "componentType", 5126 }, { "type", "VEC3" }, { "count", 30'000 } });
	for (int i = 0; i < 4; ++i)
		file.addPrimitive({ { "POSITION", 0 } });
	const std::filesystem::path path = file.write(folder.path);
	size_t refused = 0;
	for (size_t kilobytes = 64; kilobytes < 40'000; kilobytes = kilobytes * 4 / 3)
	{
		const int outcome = outcomeWith(kilobytes << 10, path);
		EXPECT_TRUE(outcome == kRefused || outcome == kLoaded) << outcome << " with " << kilobytes << " kB";
		refused += outcome == kRefused;
	}
	EXPECT_GT(refused, 10u);
	EXPECT_EQ(outcomeWith(size_t(2) << 30, path), kLoaded);
}

TEST(outOfMemory, inAThreadComesOutOfParallelFor)
{
	std::atomic<int> calls = 0;
	const auto body = [&](size_t i) {
		++calls;
		if (i == 3)
			throw std::bad_alloc();
	};
	EXPECT_THROW(parallelFor(1000, body), std::bad_alloc);
	EXPECT_GT(calls, 0);
}

}  // namespace tessera
