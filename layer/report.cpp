#include "layer/report.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace tessera::layer
{

namespace
{

constexpr uint64_t kPrintedPerName = 8;  // one wrong stride is wrong for every cluster of every frame

std::string quoted(const std::string& text)
{
	std::string out = "\"";
	for (const char c : text)
	{
		if (c == '"' || c == '\\')
			out += '\\';
		out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
	}
	return out + '"';
}

template <typename Map, typename Value>
std::string object(const Map& map, Value value)
{
	std::string out;
	for (const auto& [name, entry] : map)
		out += fmt::format("{}\n    {}: {}", out.empty() ? "" : ",", quoted(name), value(entry));
	return out.empty() ? "{}" : "{" + out + "\n  }";
}

}  // namespace

void Report::add(Names& names, std::string_view name, const std::string& text)
{
	const std::lock_guard guard(lock_);
	Found& found = names.try_emplace(std::string(name)).first->second;
	if (found.count++ == 0)
		found.first = text;
	if (found.count <= kPrintedPerName)
		fmt::print(stderr, "cluster layer: {}: {}{}\n", name, text, found.count == kPrintedPerName ? " (more of these are only counted)" : "");
	const char* abort_wanted = std::getenv("TESSERA_CLUSTER_LAYER_ABORT");
	if (&names == &violations_ && abort_wanted && std::string_view(abort_wanted) != "0")
		std::abort();
}

void Report::count(std::string_view what, uint64_t number)
{
	const std::lock_guard guard(lock_);
	counts_.try_emplace(std::string(what)).first->second += number;
}

void Report::write() const
{
	static std::atomic<int> written = 0;
	const char* path = std::getenv("TESSERA_CLUSTER_LAYER_REPORT");
	if (!path)
		return;
	const std::lock_guard guard(lock_);
	const int number = ++written;
	const std::string file = number == 1 ? path : fmt::format("{}.{}", path, number);
	const auto found = [](const Found& entry) {
		return fmt::format("{{ \"count\": {}, \"first\": {} }}", entry.count, quoted(entry.first));
	};
	const auto plain = [](uint64_t value) {
		return fmt::format("{}", value);
	};
	std::FILE* out = std::fopen(file.c_str(), "w");
	if (!out)
	{
		fmt::print(stderr, "cluster layer: cannot write {} (TESSERA_CLUSTER_LAYER_REPORT)\n", file);
		return;
	}
	fmt::print(out, "{{\n  \"violations\": {},\n  \"limits\": {},\n  \"counts\": {}\n}}\n", object(violations_, found), object(limits_, found),
			   object(counts_, plain));
	std::fclose(out);
}

}  // namespace tessera::layer
