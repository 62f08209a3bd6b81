// Completes what is typed into a path field. Reads folders, nothing else.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tessera::view
{

struct Completion
{
	std::string text;                // what was typed, continued as far as it is certain
	std::vector<std::string> files;  // what it could become, sorted: folders with a slash behind them
};

// Files whose names end in one of `suffixes` (lower case, with the dot; compared without regard to case), folders, and those of `names` that begin
// so. `~` is the home folder. Hidden files appear only when the name begins with a dot.
Completion completePath(const std::string& typed, const std::vector<std::string>& suffixes, const std::vector<std::string>& names = {});

}  // namespace tessera::view
