// What an import leaves out, gathered so that the same remark about many places becomes one line.
#pragma once
#include <string>
#include <unordered_map>
#include <vector>

namespace tessera
{

// `text` with control characters replaced: names in a file must not break a message into lines.
std::string oneLine(std::string text);

class GltfWarnings
{
public:
	// `place` as in "meshes[2].primitives[0]"; `text` says what is left out or changed.
	void add(const std::string& place, const std::string& text);
	void append(const GltfWarnings& others);

	// One line per text, in the order of first mention: "file: place (and 3 more places): text".
	std::vector<std::string> lines(const std::string& file) const;

private:
	struct Entry
	{
		std::string place;
		std::string text;
		size_t count = 0;
	};

	void addCounted(const std::string& place, const std::string& text, size_t count);

	std::vector<Entry> m_entries;
	std::unordered_map<std::string, size_t> m_entry_of_text;
};

}  // namespace tessera
