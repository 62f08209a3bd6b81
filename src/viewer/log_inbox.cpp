#include "viewer/log_inbox.h"

#include "base/log.h"

#include <utility>

namespace tessera::view
{

LogInbox::LogInbox()
{
	setLogListener([this](LogLevel level, const std::string& text) {
		const std::lock_guard lock(mutex_);
		entries_.push_back({ text, level == LogLevel::Quiet });
	});
}

LogInbox::~LogInbox()
{
	setLogListener({});
}

std::vector<LogEntry> LogInbox::take()
{
	const std::lock_guard lock(mutex_);
	return std::exchange(entries_, {});
}

}  // namespace tessera::view
