// The command line: which command, on what, with which options.
#pragma once
#include "app/options.h"

namespace tessera
{

enum class Command : uint8_t
{
	ShowText,  // --help, --version
	Render,
	Report,
	Export,
	Info,
	Verify,
	View,
};

struct CommandLine
{
	Command command = Command::ShowText;
	std::string text;   // of ShowText
	std::string scene;  // file or builtin:name; empty: none given
	std::string output;
	std::string stats;            // file, "-" = standard output, empty = none; of verify: its report
	uint32_t random_cameras = 6;  // of verify
	uint64_t seed = 1;
	std::string inject;             // a fault's name; empty: none
	std::string against;            // a second device; empty: none
	std::string suite;              // of verify: instead of a scene; empty: none
	uint32_t leak_views = 0;        // of verify: only the check no_leaks, from this many random places; 0: every check
	bool paints_violations = true;  // of verify: what -o shows; false: what --view says
	bool usual_way = false;         // of verify
	bool base = false, print_plan = false, json = false;
	// of view
	bool shows_interface = true;
	std::string ui_state;      // file; empty: none
	std::string shaders;       // folder of GLSL sources; empty: the program's own
	std::string settings;      // file; empty: the user's own; "off": none
	bool has_size = false;     // --size was given
	uint32_t frame_limit = 0;  // ends after this many; 0: when it is closed
	AppOptions options;
};

// `arguments` without the program's name. Errors: Usage, one line that names the argument and says what would be right.
Result<CommandLine> parseCommandLine(const std::vector<std::string>& arguments);

}  // namespace tessera
