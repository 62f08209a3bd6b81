// What the program tells the user while it works. Warnings and progress go to stderr, so stdout stays machine-readable.
#pragma once
#include <fmt/format.h>

#include <functional>
#include <string>

namespace tessera
{

enum class LogLevel
{
	Quiet,   // warnings only
	Normal,  // progress and results
};

void setLogLevel(LogLevel level);
// Gets every line as well, from whatever thread logs it; empty: nobody.
void setLogListener(std::function<void(LogLevel, const std::string&)> listener);
void logLine(LogLevel level, const std::string& text);

template <typename... Args>
void logInfo(fmt::format_string<Args...> format, Args&&... args)
{
	logLine(LogLevel::Normal, fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void logWarning(fmt::format_string<Args...> format, Args&&... args)
{
	logLine(LogLevel::Quiet, "warning: " + fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace tessera
