#include "base/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <mutex>
#include <utility>

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

struct Listener
{
	std::mutex mutex;
	std::function<void(LogLevel, const std::string&)> call;
};

static Listener& listener()
{
	static Listener instance;
	return instance;
}

void setLogListener(std::function<void(LogLevel, const std::string&)> call)
{
	const std::lock_guard lock(listener().mutex);
	listener().call = std::move(call);
}

void logLine(LogLevel level, const std::string& text)
{
	{
		const std::lock_guard lock(listener().mutex);
		if (listener().call)
			listener().call(level, text);
	}
	logger().log(level == LogLevel::Quiet ? spdlog::level::warn : spdlog::level::info, "{}", text);
}

}  // namespace tessera
