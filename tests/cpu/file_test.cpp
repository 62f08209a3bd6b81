// Files are there whole or not at all, whatever happens to the program that writes them.
#include "base/file.h"
#include "gltf_file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace tessera
{

namespace
{

namespace fs = std::filesystem;

constexpr size_t kBytes = size_t(192) << 20;  // takes many times as long as the pauses below

size_t fileCount(const fs::path& folder)
{
	return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

// Writes in a process of its own, which is killed after `pause`. True when it was still at it.
bool killedWhileWriting(const fs::path& path, std::span<const std::byte> bytes, std::chrono::milliseconds pause)
{
	const pid_t child = fork();
	if (child == 0)
		_exit(writeFile(path, bytes) ? 0 : 1);
	std::this_thread::sleep_for(pause);
	kill(child, SIGKILL);
	int status = 0;
	waitpid(child, &status, 0);
	return WIFSIGNALED(status);
}

}  // namespace

TEST(writeFile, aKilledRunLeavesNothingBehind)
{
	const TemporaryFolder folder;
	const std::vector<std::byte> bytes(kBytes, std::byte(7));
	size_t killed = 0;
	for (const int pause_ms : { 1, 2, 4, 8, 12, 16, 24, 32 })
	{
		if (killedWhileWriting(folder.path / "new.bin", bytes, std::chrono::milliseconds(pause_ms)))
		{
			++killed;
			// All or nothing: killed between the last byte and the end of the program the file is whole.
			if (fs::exists(folder.path / "new.bin"))
				EXPECT_EQ(fs::file_size(folder.path / "new.bin"), kBytes);
			else
				EXPECT_EQ(fileCount(folder.path), 0u) << "after " << pause_ms << " ms";
		}
		fs::remove(folder.path / "new.bin");
	}
	EXPECT_GT(killed, 0u) << "every run was over before it was killed";
}

TEST(writeFile, aKilledRunLeavesTheOldFileAsItWas)
{
	const TemporaryFolder folder;
	const fs::path path = folder.path / "old.bin";
	ASSERT_TRUE(writeFile(path, std::string_view("before")));
	const std::vector<std::byte> bytes(kBytes, std::byte(9));
	for (const int pause_ms : { 1, 4, 16 })
		if (killedWhileWriting(path, bytes, std::chrono::milliseconds(pause_ms)) && fs::file_size(path) != kBytes)
		{
			EXPECT_EQ(readBytes(path).size(), 6u);
			EXPECT_EQ(fileCount(folder.path), 1u);
		}
}

TEST(writeFile, replacesWhatIsThereAndMakesFolders)
{
	const TemporaryFolder folder;
	const fs::path path = folder.path / "a/b/text";
	ASSERT_TRUE(writeFile(path, std::string_view("one")));
	ASSERT_TRUE(writeFile(path, std::string_view("three")));
	EXPECT_EQ(readBytes(path).size(), 5u);
	EXPECT_EQ(fileCount(path.parent_path()), 1u);
	EXPECT_EQ(fs::status(path).permissions() & fs::perms::owner_write, fs::perms::owner_write);
}

TEST(writeFile, whereNothingCanBeWrittenSaysSoInOneLine)
{
	const TemporaryFolder folder;
	ASSERT_TRUE(fs::create_directory(folder.path / "taken"));
	for (const fs::path& path : { folder.path / "taken", fs::path("/proc/no/such/place") })
	{
		const Status status = writeFile(path, std::string_view("text"));
		ASSERT_FALSE(status) << path;
		EXPECT_EQ(status.error().code, ExitCode::BadInput);
		EXPECT_TRUE(status.error().message.starts_with(path.string())) << status.error().message;
		EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
	}
	EXPECT_EQ(fileCount(folder.path), 1u);
}

}  // namespace tessera
