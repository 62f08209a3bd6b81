#include "app/command_line.h"

#include "app/option_text.h"
#include "scene/builtin.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

namespace tessera
{

namespace
{

struct CommandDesc
{
	Command command;
	std::string_view name, help;
};

constexpr CommandDesc kCommands[] = {
	{ Command::View, "view", "open a window on SCENE: turn it, change every option, see what every stage does" },
	{ Command::Render, "render", "draw one picture of SCENE" },
	{ Command::Report, "report", "measure error against run time of SCENE at several rates; a page with plots and a recommendation" },
	{ Command::Export, "export", "write the micro-triangles of SCENE as a mesh, .glb or .ply; all of them unless --cull is given" },
	{ Command::Info, "info", "what the device offers, what SCENE needs, what is left out and why" },
	{ Command::Verify, "verify", "check that SCENE is drawn watertight, without holes, whatever is culled, the same every time, and right" },
};

constexpr const char* kSharedGroup = "shared";

// Leaves the shared options to optionsHelp, so that every help page shows them alike.
struct HelpFormatter final : CLI::Formatter
{
	std::string make_group(std::string group, bool is_positional, std::vector<const CLI::Option*> options) const override
	{
		return group == kSharedGroup ? "" : Formatter::make_group(std::move(group), is_positional, std::move(options));
	}
};

std::string sceneHelp()
{
	std::string text = "SCENE is a .gltf or .glb file, or one of\n";
	for (const BuiltinScene& scene : builtinScenes())
		text += fmt::format("  {:<28}  {}\n", fmt::format("builtin:{}{}", scene.name, scene.default_count ? "[:COUNT]" : ""), scene.help);
	return text;
}

void addVerifyOptions(CLI::App& app, CommandLine& line)
{
	app.add_option("--cameras", line.random_cameras,
				   "random cameras beside the chosen one and the scene's: far, close, inside, grazing, narrow, wide")
		->type_name("N")
		->check(CLI::Range(0u, 1000000u))
		->capture_default_str();
	app.add_option("--seed", line.seed, "of cameras, orders and faults")->type_name("N")->capture_default_str();
	app.add_option("--json", line.stats, "the report as JSON; - is standard output")->type_name("FILE|-");
	app.add_option("--inject", line.inject, "break something on purpose: the check that guards it must fail")
		->type_name("FAULT")
		->check(CLI::IsMember({ "crack", "drop", "cull", "nan", "tie" }));
	app.add_flag("--usual-way", line.usual_way,
				 "also count the cracks that displacing each side by its own normals and texture coordinates would open");
	app.add_option("--against", line.against, "another device, compared with the first")->type_name("NAME|N");
	app.add_option("--leaks", line.leak_views, "only: does background shine through, from N random places? Fast enough for thousands")
		->type_name("N")
		->check(CLI::Range(1u, 1000000u));
	app.add_option("--suite", line.suite, "instead of a SCENE: extreme input made in code; extreme-quick is the part that takes minutes")
		->type_name("NAME[:FAMILY|:CASE]");
}

void addViewOptions(CLI::App& app, CommandLine& line)
{
	app.add_option_function<std::string>(
		   "--ui", [&line](const std::string& text) { line.shows_interface = text == "on"; }, "panels at the start (F1 shows and hides them)")
		->type_name("on|off")
		->check(CLI::IsMember({ "on", "off" }));
	app.add_option("--ui-state", line.ui_state, "what the window shows and where its controls are, as JSON; written at the end and with F9")
		->type_name("FILE");
	app.add_option("--shaders", line.shaders, "sources of the shaders, compiled again on R and when one changes; default: the program's own")
		->type_name("FOLDER");
	app.add_option("--settings", line.settings, "how the window was left, kept between starts; default: view.json in the user's configuration folder")
		->type_name("FILE|off");
}

std::string outputHelp(Command command)
{
	switch (command)
	{
	case Command::Render:
		return "picture (default tessera.png)";
	case Command::Report:
		return "folder to write (default report)";
	case Command::Verify:
		return "picture of the frame with most violations (.png), marked red, which is --view violations; or as another --view shows it";
	default:
		return "file to write";
	}
}

void addCommandOptions(CLI::App& app, CommandLine& line)
{
	const char* otherwise = line.command == Command::Info ? "default: none" : "default: the first built-in scene";
	app.add_option("SCENE", line.scene, otherwise)->type_name("");
	if (line.command == Command::View)
		addViewOptions(app, line);
	else if (line.command != Command::Info)
		app.add_option("-o,--output", line.output, outputHelp(line.command))->type_name(line.command == Command::Report ? "FOLDER" : "FILE");
	if (line.command == Command::Render)
		app.add_option("--stats", line.stats, "counts and times as JSON; - is standard output")->type_name("FILE|-");
	if (line.command == Command::Export)
		app.add_flag("--base", line.base, "the scene as loaded, before tessellation (.glb)");
	if (line.command == Command::Verify)
		addVerifyOptions(app, line);
	if (line.command == Command::Info)
	{
		app.add_flag("--print-plan", line.print_plan, "passes, barriers and resources of a frame, and why the others are left out");
		app.add_flag("--json", line.json, "as JSON");
	}
}

// Rows of the table are read as text here and understood by setOption, so that errors are ours.
void addSharedOptions(CLI::App& app, AppOptions& options, Status& status)
{
	for (const OptionDesc& option : optionTable())
	{
		const std::string name = "--" + std::string(option.name);
		const auto set = [&option, &options, &status](const std::string& text) {
			if (status)
				status = setOption(option, text, options);
		};
		if (option.value.empty())
			app.add_flag_callback(name, [set] { set(""); })->group(kSharedGroup);
		else
			app.add_option(name,
						   [set](const CLI::results_t& values) {
							   std::for_each(values.begin(), values.end(), set);
							   return true;
						   })
				->expected(1)
				->type_name(std::string(option.value))
				->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
				->group(kSharedGroup);
	}
}

std::string mainHelp()
{
	std::string text = "tessera draws displaced glTF models with as many triangles as the picture needs.\n\n"
					   "Usage: tessera COMMAND [SCENE] [OPTIONS]\n\nCommands (tessera COMMAND --help says more)\n";
	for (const CommandDesc& command : kCommands)
		text += fmt::format("  {:<28}  {}\n", command.name, command.help);
	text += "  --version\n  --help\n";
	return text + "\n" + sceneHelp() + "\nOptions of every command\n" + optionsHelp();
}

// Violations are painted from what verify read back, so no shader knows that view. Takes it out of the arguments; returns whether the picture
// shows it: unless another view is asked for.
bool takeViolationsView(std::vector<std::string>& arguments)
{
	bool other = false;
	for (size_t i = 0; i + 1 < arguments.size(); ++i)
	{
		if (arguments[i] != "--view")
			continue;
		other = arguments[i + 1] != "violations";
		if (other)
			continue;
		arguments.erase(arguments.begin() + std::ptrdiff_t(i), arguments.begin() + std::ptrdiff_t(i) + 2);
		--i;
	}
	return !other;
}

Result<CommandLine> parseCommand(const CommandDesc& command, std::vector<std::string> arguments)
{
	CommandLine line;
	line.command = command.command;
	Status status;
	CLI::App app{ std::string(command.help), "tessera " + std::string(command.name) };
	app.formatter(std::make_shared<HelpFormatter>());
	app.get_formatter()->column_width(32);
	if (command.command == Command::Verify)
	{
		TRY(setOption(*findOption("size"), "640x360", line.options));
		line.paints_violations = takeViolationsView(arguments);
	}
	if (command.command == Command::View)
		TRY(setOption(*findOption("size"), "1280x720", line.options));
	if (command.command == Command::Export)
		TRY(setOption(*findOption("cull"), "off", line.options));
	addCommandOptions(app, line);
	addSharedOptions(app, line.options, status);
	app.footer(sceneHelp() + "\nOptions of every command\n" + optionsHelp());
	try
	{
		std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them last first
		app.parse(arguments);
	}
	catch (const CLI::CallForHelp&)
	{
		line.command = Command::ShowText;
		line.text = app.help();
		return line;
	}
	catch (const CLI::ParseError& error)
	{
		return fail(ExitCode::Usage, "{}: {}; `tessera {} --help` lists what it takes", command.name, error.what(), command.name);
	}
	TRY(status);
	line.has_size = app.count("--size") > 0;
	if (command.command == Command::View && app.count("--frames") > 0)
		line.frame_limit = line.options.frames;
	return line;
}

}  // namespace

Result<CommandLine> parseCommandLine(const std::vector<std::string>& arguments)
{
	std::vector<std::string_view> names;
	for (const CommandDesc& command : kCommands)
		names.push_back(command.name);
	if (arguments.empty())
		return fail(ExitCode::Usage, "no command is given; commands are {}; `tessera --help` says more", joinNames(names));
	CommandLine line;
	if (arguments[0] == "--version")
	{
		line.text = "tessera " TESSERA_VERSION "\n";
		return line;
	}
	if (arguments[0] == "--help" || arguments[0] == "-h")
	{
		line.text = mainHelp();
		return line;
	}
	for (const CommandDesc& command : kCommands)
		if (command.name == arguments[0])
			return parseCommand(command, { arguments.begin() + 1, arguments.end() });
	return fail(ExitCode::Usage, "{}: there is no such command; commands are {}; `tessera --help` says more", arguments[0], joinNames(names));
}

}  // namespace tessera
