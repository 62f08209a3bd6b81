#include "scene/gltf/uri.h"

#include "base/file.h"
#include "scene/gltf/warnings.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <system_error>

namespace tessera
{

namespace fs = std::filesystem;

static int hexDigit(char c)
{
	if (c >= '0' && c <= '9')
		return c - '0';
	if (c >= 'a' && c <= 'f')
		return c - 'a' + 10;
	if (c >= 'A' && c <= 'F')
		return c - 'A' + 10;
	return -1;
}

std::string shownUri(std::string_view uri)
{
	constexpr size_t kShown = 80;
	return fmt::format("\"{}{}\"", oneLine(std::string(uri.substr(0, kShown))), uri.size() > kShown ? "..." : "");
}

Result<std::string> percentDecoded(std::string_view text)
{
	std::string decoded;
	decoded.reserve(text.size());
	for (size_t i = 0; i < text.size(); ++i)
	{
		if (text[i] != '%')
		{
			decoded += text[i];
			continue;
		}
		const int high = i + 2 < text.size() ? hexDigit(text[i + 1]) : -1;
		const int low = i + 2 < text.size() ? hexDigit(text[i + 2]) : -1;
		if (high < 0 || low < 0)
			return badInput("{} has a % that two hexadecimal digits do not follow", shownUri(text));
		decoded += static_cast<char>(high * 16 + low);
		i += 2;
	}
	return decoded;
}

static bool hasScheme(std::string_view uri)
{
	const size_t colon = uri.find(':');
	if (colon == std::string_view::npos || colon == 0)
		return false;
	return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
					   [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

static bool isInside(const fs::path& folder, const fs::path& file)
{
	const auto [folder_end, ignored] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
	return folder_end == folder.end();
}

Result<fs::path> confinedPath(const fs::path& folder, std::string_view uri)
{
	TRY_ASSIGN(const std::string decoded, percentDecoded(uri));
	if (decoded.empty())
		return badInput("the URI is empty; a file name relative to the glTF file is right");
	if (decoded.find('\0') != std::string::npos)
		return badInput("{} contains a NUL byte", shownUri(uri));
	if (hasScheme(uri))
		return badInput("{} is not a relative file name; only files beside the glTF file and base64 data are read", shownUri(uri));
	if (decoded.find('\\') != std::string::npos)
		return badInput("{} contains a backslash; folders are separated by / in a URI", shownUri(uri));

	const fs::path relative = fs::path(decoded).lexically_normal();
	if (relative.is_absolute() || relative.has_root_path())
		return badInput("{} is an absolute path; a file name relative to the glTF file is right", shownUri(uri));
	if (!relative.empty() && *relative.begin() == "..")
		return badInput("{} leads out of the glTF file's folder; move the file beside the glTF file", shownUri(uri));

	// Links inside the folder must not lead out of it either.
	std::error_code code;
	const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, code);
	const fs::path file = code ? fs::path() : fs::weakly_canonical(base / relative, code);
	if (code)
		return badInput("{} cannot be resolved: {}", shownUri(uri), code.message());
	if (!isInside(base, file))
		return badInput("{} is a link that leads out of the glTF file's folder; copy the file beside the glTF file", shownUri(uri));
	return folder / relative;
}

static std::array<int8_t, 256> makeBase64Values()
{
	constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	std::array<int8_t, 256> values;
	values.fill(-1);
	for (size_t i = 0; i < kDigits.size(); ++i)
		values[static_cast<unsigned char>(kDigits[i])] = static_cast<int8_t>(i);
	return values;
}

// Nothing when a character is no base64 digit or the length is impossible. Padding may be missing.
static std::optional<std::vector<std::byte>> base64Decoded(std::string_view text)
{
	static const std::array<int8_t, 256> values = makeBase64Values();
	for (int i = 0; i < 2 && text.ends_with('='); ++i)
		text.remove_suffix(1);
	if (text.size() % 4 == 1)
		return {};
	std::vector<std::byte> bytes;
	bytes.reserve(text.size() / 4 * 3 + 2);
	uint32_t bits = 0;
	int bit_count = 0;
	for (const char c : text)
	{
		const int value = values[static_cast<unsigned char>(c)];
		if (value < 0)
			return {};
		bits = (bits << 6 | static_cast<uint32_t>(value)) & 0xffffffu;
		bit_count += 6;
		if (bit_count >= 8)
		{
			bit_count -= 8;
			bytes.push_back(static_cast<std::byte>(bits >> bit_count & 255u));
		}
	}
	return bytes;
}

static Result<std::vector<std::byte>> dataUriContent(std::string_view uri)
{
	const size_t comma = uri.find(',');
	if (comma == std::string_view::npos)
		return badInput("{} has no comma before its data", shownUri(uri));
	const std::string_view head = uri.substr(0, comma);
	const std::string_view data = uri.substr(comma + 1);
	const bool is_escaped = data.find('%') != std::string_view::npos;
	std::string unescaped;
	if (is_escaped)
	{
		TRY_ASSIGN(unescaped, percentDecoded(data));
	}
	const std::string_view text = is_escaped ? std::string_view(unescaped) : data;
	if (!head.ends_with(";base64"))
	{
		const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
		return std::vector<std::byte>(bytes.begin(), bytes.end());
	}
	std::optional<std::vector<std::byte>> decoded = base64Decoded(text);
	if (!decoded)
		return badInput("{} is not valid base64", shownUri(uri));
	return std::move(*decoded);
}

Result<std::vector<std::byte>> readUri(const fs::path& folder, std::string_view uri)
{
	if (uri.starts_with("data:"))
		return dataUriContent(uri);
	TRY_ASSIGN(const fs::path path, confinedPath(folder, uri));
	std::error_code code;
	const fs::file_status status = fs::status(path, code);
	if (!fs::exists(status))
		return badInput("{} does not exist beside the glTF file", shownUri(uri));
	if (!fs::is_regular_file(status))
		return badInput("{} is not a regular file", shownUri(uri));
	return readFile(path);
}

}  // namespace tessera
