#include "base/file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace tessera
{

namespace fs = std::filesystem;

struct FileCloser
{
	void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

Result<std::vector<std::byte>> readFile(const fs::path& path, uint64_t max_bytes)
{
	std::error_code code;
	if (fs::is_directory(path, code))
		return badInput("{}: is a folder, a file is needed", path.string());
	const File file(std::fopen(path.c_str(), "rb"));
	if (!file)
		return badInput("{}: cannot be opened: {}", path.string(), std::strerror(errno));
	const uint64_t size = fs::file_size(path, code);
	if (code)
		return badInput("{}: cannot be read: {}", path.string(), code.message());
	if (size > max_bytes)
		return badInput("{}: {} bytes are too many, at most {} can be read", path.string(), size, max_bytes);
	std::vector<std::byte> bytes(size);
	if (std::fread(bytes.data(), 1, size, file.get()) != size)
		return badInput("{}: cannot be read to its end", path.string());
	return bytes;
}

Status writeFile(const fs::path& path, std::span<const std::byte> bytes)
{
	std::error_code code;
	if (path.has_parent_path())
		fs::create_directories(path.parent_path(), code);
	if (code)
		return badInput("{}: its folder cannot be made: {}", path.string(), code.message());
	const fs::path temporary = path.string() + ".part";
	{
		const File file(std::fopen(temporary.c_str(), "wb"));
		const bool written = file && std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size() && std::fflush(file.get()) == 0;
		if (!written)
		{
			const int reason = errno;
			fs::remove(temporary, code);
			return badInput("{}: cannot be written: {}", path.string(), std::strerror(reason));
		}
	}
	fs::rename(temporary, path, code);
	if (!code)
		return {};
	const std::string reason = code.message();
	fs::remove(temporary, code);
	return badInput("{}: cannot be written: {}", path.string(), reason);
}

Status writeFile(const fs::path& path, std::string_view text)
{
	return writeFile(path, std::as_bytes(std::span(text.data(), text.size())));
}

fs::path programFolder()
{
	std::error_code code;
	const fs::path program = fs::read_symlink("/proc/self/exe", code);
	return code ? fs::current_path() : program.parent_path();
}

}  // namespace tessera
