#include "scene/gltf/warnings.h"

#include <fmt/format.h>

namespace tessera
{

std::string oneLine(std::string text)
{
	for (char& c : text)
		if (static_cast<unsigned char>(c) < 32 || c == 127)
			c = '?';
	return text;
}

void GltfWarnings::add(const std::string& place, const std::string& text)
{
	addCounted(place, text, 1);
}

void GltfWarnings::append(const GltfWarnings& others)
{
	for (const Entry& entry : others.m_entries)
		addCounted(entry.place, entry.text, entry.count);
}

void GltfWarnings::addCounted(const std::string& place, const std::string& text, size_t count)
{
	const auto [found, inserted] = m_entry_of_text.try_emplace(text, m_entries.size());
	if (inserted)
		m_entries.push_back({ place, text, 0 });
	m_entries[found->second].count += count;
}

std::vector<std::string> GltfWarnings::lines(const std::string& file) const
{
	std::vector<std::string> result;
	for (const Entry& entry : m_entries)
	{
		const std::string more = entry.count == 1 ? "" : fmt::format(" (and {} more place{})", entry.count - 1, entry.count == 2 ? "" : "s");
		result.push_back(oneLine(fmt::format("{}: {}{}: {}", file, entry.place, more, entry.text)));
	}
	return result;
}

}  // namespace tessera
