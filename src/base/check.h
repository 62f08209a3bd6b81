// CHECK: our own bugs. Always on; prints the condition, the values and what was being worked on, then aborts.
#pragma once
#include <fmt/format.h>

#include <string>
#include <string_view>

namespace tessera
{

// What the program is working on (a file, a pass): printed by a failing CHECK and by a lost device.
void setWorkingOn(std::string what);
std::string workingOn();

[[noreturn]] void checkFailed(const char* file, int line, const char* condition, const std::string& message);

}  // namespace tessera

#define CHECK(condition, ...)                                                                    \
	do                                                                                           \
	{                                                                                            \
		if (!(condition)) [[unlikely]]                                                           \
			::tessera::checkFailed(__FILE__, __LINE__, #condition, fmt::format("" __VA_ARGS__)); \
	} while (false)

#ifdef NDEBUG
#define DCHECK(condition, ...) ((void)0)
#else
#define DCHECK(condition, ...) CHECK(condition, __VA_ARGS__)
#endif
