// Runs the built program as a user would.
#pragma once
#include <filesystem>
#include <string>

namespace tessera::test
{

struct ProgramRun
{
	int exit_code = -1;
	std::string output;  // standard output
	std::string errors;  // standard error
};

// `arguments` as a shell reads them.
ProgramRun runTessera(const std::string& arguments);

// A folder of this test process that is removed at its end.
std::filesystem::path scratchFolder();

}  // namespace tessera::test
