#include "base/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace tessera
{

static spdlog::logger& logger()
{
	static const std::shared_ptr<spdlog::logger> instance = [] {
		auto made = spdlog::stderr_logger_mt("tessera");
		made->set_pattern("%v");
		made->flush_on(spdlog::level::info);
		return made;
	}();
	return *instance;
}

void setLogLevel(LogLevel level)
{
	logger().set_level(level == LogLevel::Quiet ? spdlog::level::warn : spdlog::level::info);
}

void logLine(LogLevel level, const std::string& text)
{
	logger().log(level == LogLevel::Quiet ? spdlog::level::warn : spdlog::level::info, "{}", text);
}

}  // namespace tessera
