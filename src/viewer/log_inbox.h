// What the program logs, from whatever thread, kept until the window asks for it.
#pragma once
#include "viewer/session.h"

#include <mutex>

namespace tessera::view
{

// Listens from its making to its end; one at a time.
class LogInbox
{
public:
	LogInbox();
	~LogInbox();
	LogInbox(const LogInbox&) = delete;
	LogInbox& operator=(const LogInbox&) = delete;

	std::vector<LogEntry> take();

private:
	std::mutex mutex_;
	std::vector<LogEntry> entries_;
};

}  // namespace tessera::view
