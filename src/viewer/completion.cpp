#include "viewer/completion.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

namespace tessera::view
{

namespace fs = std::filesystem;

namespace
{

std::string lower(std::string text)
{
	for (char& c : text)
		c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
	return text;
}

bool hasSuffix(const std::string& name, const std::vector<std::string>& suffixes)
{
	const std::string lowered = lower(name);
	return std::any_of(suffixes.begin(), suffixes.end(), [&](const std::string& suffix) { return lowered.ends_with(suffix); });
}

std::string expandHome(const std::string& typed)
{
	const char* home = std::getenv("HOME");
	return home && (typed == "~" || typed.starts_with("~/")) ? home + typed.substr(1) : typed;
}

std::string commonBeginning(const std::vector<std::string>& texts)
{
	std::string common = texts.front();
	for (const std::string& text : texts)
		common.resize(static_cast<size_t>(std::mismatch(common.begin(), common.end(), text.begin(), text.end()).first - common.begin()));
	return common;
}

}  // namespace

Completion completePath(const std::string& typed, const std::vector<std::string>& suffixes, const std::vector<std::string>& names)
{
	Completion completion = { typed, {} };
	for (const std::string& name : names)
		if (name.starts_with(typed))
			completion.files.push_back(name);
	const std::string path = expandHome(typed);
	const size_t slash = path.rfind('/');
	const std::string folder = slash == std::string::npos ? "" : path.substr(0, slash + 1), begin = path.substr(folder.size());
	std::error_code error;
	fs::directory_iterator entry(folder.empty() ? fs::path(".") : fs::path(folder), error);
	for (; !error && entry != fs::directory_iterator(); entry.increment(error))
	{
		const std::string name = entry->path().filename().string();
		if (!name.starts_with(begin) || (name.starts_with('.') && begin.empty()))
			continue;
		std::error_code ignored;
		if (entry->is_directory(ignored))
			completion.files.push_back(folder + name + "/");
		else if (hasSuffix(name, suffixes))
			completion.files.push_back(folder + name);
	}
	std::sort(completion.files.begin(), completion.files.end());
	if (!completion.files.empty())
		completion.text = commonBeginning(completion.files);
	return completion;
}

}  // namespace tessera::view
