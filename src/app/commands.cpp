#include "app/commands.h"

#include "base/log.h"
#include "viewer/viewer.h"

#include <cstdio>
#include <new>

namespace tessera
{

namespace
{

Status runCommand(const CommandLine& line)
{
	setLogLevel(line.options.quiet ? LogLevel::Quiet : LogLevel::Normal);
	switch (line.command)
	{
	case Command::ShowText:
		std::fputs(line.text.c_str(), stdout);
		return {};
	case Command::Render:
		return renderCommand(line);
	case Command::Report:
		return reportCommand(line);
	case Command::Export:
		return exportCommand(line);
	case Command::Info:
		return infoCommand(line);
	case Command::Verify:
		return verifyCommand(line);
	case Command::View:
		return viewCommand(line);
	}
	return {};
}

Status parseAndRun(const std::vector<std::string>& arguments)
{
	try
	{
		TRY_ASSIGN(const CommandLine line, parseCommandLine(arguments));
		return runCommand(line);
	}
	catch (const std::bad_alloc&)
	{
		return badInput("out of memory: a smaller scene, --size or --capacity is needed");
	}
}

// Whatever a message quotes, it stays one line.
std::string oneLine(std::string text)
{
	for (char& c : text)
		if (static_cast<unsigned char>(c) < ' ')
			c = ' ';
	return text;
}

}  // namespace

int runProgram(const std::vector<std::string>& arguments)
{
	const Status status = parseAndRun(arguments);
	if (status)
		return static_cast<int>(ExitCode::Fine);
	fmt::print(stderr, "tessera: error: {}\n", oneLine(status.error().message));
	return static_cast<int>(status.error().code);
}

}  // namespace tessera
