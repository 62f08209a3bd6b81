#include "report/run_log.h"

#include "base/file.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string_view>

namespace tessera::report
{

using nlohmann::json;

namespace
{

std::string lineOf(const json& value)
{
	return value.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

// The path of the first value that differs, such as "options/size"; empty when none does.
std::string firstDifference(const json& a, const json& b, const std::string& path = "")
{
	if (a == b)
		return "";
	if (!a.is_object() || !b.is_object())
		return fmt::format("{} is {} there and {} now", path, a.dump(), b.dump());
	json keys = a;
	keys.update(b);
	for (const auto& [key, value] : keys.items())
	{
		const std::string difference = firstDifference(a.value(key, json()), b.value(key, json()), path.empty() ? key : path + "/" + key);
		if (!difference.empty())
			return difference;
	}
	return "";
}

// Whole lines; what follows the last end of line was cut off.
std::vector<std::string_view> linesOf(std::string_view text)
{
	std::vector<std::string_view> lines;
	for (size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n'))
	{
		lines.push_back(text.substr(0, end));
		text.remove_prefix(end + 1);
	}
	return lines;
}

}  // namespace

Result<RunLog> RunLog::start(const std::filesystem::path& path, const json& facts)
{
	TRY(writeFile(path, std::string_view(lineOf({ { "report", 1 }, { "facts", facts } }))));
	return RunLog(path);
}

Result<RunLog> RunLog::resume(const std::filesystem::path& path, const json& facts)
{
	std::error_code code;
	if (!std::filesystem::exists(path, code))
		return start(path, facts);
	TRY_ASSIGN(const std::vector<std::byte> bytes, readFile(path));
	const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
	const std::vector<std::string_view> lines = linesOf(text);
	if (lines.empty())
		return start(path, facts);
	// Through text and back, so that numbers compare as they were written.
	const json wanted = json::parse(lineOf(facts));
	const json head = json::parse(lines[0], nullptr, false);
	if (!head.is_object() || head.value("report", 0) != 1)
		return badInput("{}: line 1: not the log of a report", path.string());
	const std::string difference = firstDifference(head.value("facts", json()), wanted);
	if (!difference.empty())
		return badInput("{}: its runs cannot be gone on with: {}; leave --resume out, or give another -o", path.string(), difference);
	RunLog log(path);
	std::string kept(lines[0]);
	kept += '\n';
	for (size_t i = 1; i < lines.size(); ++i)
	{
		const std::string where = fmt::format("{}: line {}", path.string(), i + 1);
		const json line = json::parse(lines[i], nullptr, false);
		if (line.is_discarded())
			return badInput("{}: not JSON", where);
		TRY_ASSIGN(Run run, runFromJson(line, where));
		log.runs_.push_back(std::move(run));
		kept.append(lines[i]).append("\n");
	}
	if (kept.size() != text.size())
		TRY(writeFile(path, std::string_view(kept)));
	return log;
}

const Run* RunLog::find(const Setting& setting) const
{
	const auto found = std::find_if(runs_.begin(), runs_.end(), [&](const Run& run) { return run.setting == setting; });
	return found == runs_.end() ? nullptr : &*found;
}

Status RunLog::add(Run run)
{
	const std::string line = lineOf(runJson(run));
	const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path_.c_str(), "ab"), std::fclose);
	if (!file || std::fwrite(line.data(), 1, line.size(), file.get()) != line.size() || std::fflush(file.get()) != 0)
		return badInput("{}: cannot be written to", path_.string());
	runs_.push_back(std::move(run));
	return {};
}

}  // namespace tessera::report
