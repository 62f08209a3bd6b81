#include "program_run.h"

#include "base/file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

namespace tessera::test
{

namespace
{

struct Scratch
{
	std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("tessera_test_{}", getpid());

	Scratch() { std::filesystem::create_directories(folder); }
	~Scratch()
	{
		std::error_code code;
		std::filesystem::remove_all(folder, code);
	}
};

std::string textOf(const std::filesystem::path& path)
{
	const auto bytes = readFile(path);
	return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : std::string();
}

}  // namespace

std::filesystem::path scratchFolder()
{
	static const Scratch scratch;
	return scratch.folder;
}

ProgramRun runTessera(const std::string& arguments)
{
	const std::filesystem::path out = scratchFolder() / "stdout", err = scratchFolder() / "stderr";
	const std::string command =
		fmt::format("cd '{}' && '{}' {} > '{}' 2> '{}'", scratchFolder().string(), TESSERA_PROGRAM, arguments, out.string(), err.string());
	const int status = std::system(command.c_str());
	return { WIFEXITED(status) ? WEXITSTATUS(status) : -1, textOf(out), textOf(err) };
}

}  // namespace tessera::test
