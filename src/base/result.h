// How the world's failures travel: a value or an Error, never an exception across our functions.
#pragma once
#include <fmt/format.h>

#include <string>
#include <tl/expected.hpp>

namespace tessera
{

// Exit codes of the program; an Error carries the one it leads to.
enum class ExitCode : int
{
	Fine = 0,
	Usage = 2,
	BadInput = 3,
	DeviceCannot = 4,
	Coarsened = 5,
	CheckFailed = 6,
	DeviceLost = 7,
};

// One line for the user: the file, the place in it, what is wrong, what would be right.
struct Error
{
	ExitCode code = ExitCode::BadInput;
	std::string message;
};

template <typename T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

template <typename... Args>
[[nodiscard]] tl::unexpected<Error> fail(ExitCode code, fmt::format_string<Args...> format, Args&&... args)
{
	return tl::unexpected(Error{ code, fmt::format(format, std::forward<Args>(args)...) });
}

template <typename... Args>
[[nodiscard]] tl::unexpected<Error> badInput(fmt::format_string<Args...> format, Args&&... args)
{
	return fail(ExitCode::BadInput, format, std::forward<Args>(args)...);
}

}  // namespace tessera

#define TESSERA_CONCAT_(a, b) a##b
#define TESSERA_CONCAT(a, b) TESSERA_CONCAT_(a, b)

// TRY(Status): returns its error from the calling function.
#define TRY(expression)                                            \
	do                                                             \
	{                                                              \
		auto try_status_ = (expression);                           \
		if (!try_status_)                                          \
			return tl::unexpected(std::move(try_status_.error())); \
	} while (false)

// TRY_ASSIGN(auto x, Result<T>): declares x or returns the error.
#define TRY_ASSIGN(declaration, expression) TRY_ASSIGN_(TESSERA_CONCAT(try_result_, __LINE__), declaration, expression)
#define TRY_ASSIGN_(name, declaration, expression)      \
	auto name = (expression);                           \
	if (!name)                                          \
		return tl::unexpected(std::move(name.error())); \
	declaration = std::move(*name)
