#include "base/check.h"

#include <cstdio>
#include <cstdlib>
#include <mutex>

namespace tessera
{

static std::mutex g_working_on_mutex;
static std::string g_working_on = "start-up";

void setWorkingOn(std::string what)
{
	const std::lock_guard lock(g_working_on_mutex);
	g_working_on = std::move(what);
}

std::string workingOn()
{
	const std::lock_guard lock(g_working_on_mutex);
	return g_working_on;
}

void checkFailed(const char* file, int line, const char* condition, const std::string& message)
{
	std::fprintf(stderr, "%s:%d: check failed: %s%s%s (working on: %s)\n", file, line, condition, message.empty() ? "" : ": ", message.c_str(),
				 workingOn().c_str());
	std::abort();
}

}  // namespace tessera
