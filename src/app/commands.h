// The commands of the program.
#pragma once
#include "app/command_line.h"

namespace tessera
{

// Draws --warmup and --frames frames; writes the picture of the last and its stats.
Status renderCommand(const CommandLine& line);

// Measures error and time of the scene at --rates x --rasters x --sizes; writes a folder with report.html and the data behind it.
Status reportCommand(const CommandLine& line);

// Writes the micro-triangles that a frame draws as .glb or .ply, or the scene as loaded (--base) as .glb.
Status exportCommand(const CommandLine& line);

// Checks the promises of DESIGN.md, section 4; prints a table. Errors beside the usual: CheckFailed when one is broken.
Status verifyCommand(const CommandLine& line);
// verify --suite. Errors: Usage, those of verify::runSuite, CheckFailed when a case failed.
Status suiteCommand(const CommandLine& line);

// Prints device, scene and plan on standard output.
Status infoCommand(const CommandLine& line);

// Parses and runs; prints an error as one line. Returns the exit code.
int runProgram(const std::vector<std::string>& arguments);

}  // namespace tessera
