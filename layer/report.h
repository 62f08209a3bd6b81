// What the layer found: broken rules of the specification, and uses that it cannot emulate. Counted by name; docs/raytracing.md lists the names.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace tessera::layer
{

class Report
{
public:
	// A rule of the specification is broken. `name` is stable; the text says what, where, and what would be right.
	template <typename... Args>
	void violation(std::string_view name, fmt::format_string<Args...> format, Args&&... args)
	{
		add(violations_, name, fmt::format(format, std::forward<Args>(args)...));
	}
	// Legal, but this layer cannot do it: its result cannot be relied upon. Names start with "limit-".
	template <typename... Args>
	void limit(std::string_view name, fmt::format_string<Args...> format, Args&&... args)
	{
		add(limits_, name, fmt::format(format, std::forward<Args>(args)...));
	}
	// Counts what was done, so that a program that never came by here cannot be taken for one without violations.
	void count(std::string_view what, uint64_t number);
	// Writes everything to the file that TESSERA_CLUSTER_LAYER_REPORT names, if it does; a second device's report has ".2" appended.
	void write() const;

private:
	struct Found
	{
		uint64_t count = 0;
		std::string first;
	};
	using Names = std::map<std::string, Found, std::less<>>;

	void add(Names& names, std::string_view name, const std::string& text);

	mutable std::mutex lock_;
	Names violations_, limits_;
	std::map<std::string, uint64_t, std::less<>> counts_;
};

}  // namespace tessera::layer
