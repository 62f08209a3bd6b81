// runs.jsonl: a line of facts, then a line per run, written as each ends, so that an interrupted sweep can go on.
#pragma once
#include "report/run.h"

#include <filesystem>

namespace tessera::report
{

class RunLog
{
public:
	// Starts a new file, whose first line holds `facts` (what all runs have in common).
	static Result<RunLog> start(const std::filesystem::path& path, const nlohmann::json& facts);

	// Goes on with a file that start made; makes one when there is none. A last line that was cut off is dropped: its run is done again.
	// Errors: BadInput (the file holds runs of other facts, naming the first that differs; a broken line before the last).
	static Result<RunLog> resume(const std::filesystem::path& path, const nlohmann::json& facts);

	const std::vector<Run>& runs() const { return runs_; }
	const Run* find(const Setting& setting) const;

	// Writes the run's line and waits until the system has it.
	Status add(Run run);

private:
	explicit RunLog(std::filesystem::path path) : path_(std::move(path)) {}

	std::filesystem::path path_;
	std::vector<Run> runs_;
};

}  // namespace tessera::report
