#include "base/file.h"

#include <fcntl.h>
#include <unistd.h>

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

namespace
{

Status cannotWrite(const fs::path& path, const std::string& reason)
{
	return badInput("{}: cannot be written: {}", path.string(), reason);
}

bool writeAll(std::FILE* file, std::span<const std::byte> bytes)
{
	return std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
}

Status renameOver(const fs::path& temporary, const fs::path& path)
{
	std::error_code code;
	fs::rename(temporary, path, code);
	if (!code)
		return {};
	const std::string reason = code.message();
	fs::remove(temporary, code);
	return cannotWrite(path, reason);
}

// Under a name of its own, then renamed: a killed program leaves that name behind.
Status writeBeside(const fs::path& path, const fs::path& temporary, std::span<const std::byte> bytes)
{
	{
		const File file(std::fopen(temporary.c_str(), "wb"));
		if (!file || !writeAll(file.get(), bytes))
		{
			const std::string reason = std::strerror(errno);
			std::error_code code;
			fs::remove(temporary, code);
			return cannotWrite(path, reason);
		}
	}
	return renameOver(temporary, path);
}

#ifdef O_TMPFILE
// Without a name until it is whole: a program that is killed leaves nothing behind. `named`: false when the file system cannot do that.
Status writeNameless(const fs::path& path, const fs::path& temporary, std::span<const std::byte> bytes, bool& named)
{
	const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
	const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
	const File file(descriptor >= 0 ? ::fdopen(descriptor, "wb") : nullptr);
	named = file != nullptr;
	if (!named)
		return {};
	if (!writeAll(file.get(), bytes))
		return cannotWrite(path, std::strerror(errno));
	const std::string self = fmt::format("/proc/self/fd/{}", descriptor);
	if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0)
		return {};
	// A link replaces nothing, so what is there is replaced by a rename.
	std::error_code code;
	fs::remove(temporary, code);
	named = ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, temporary.c_str(), AT_SYMLINK_FOLLOW) == 0;
	return named ? renameOver(temporary, path) : Status();
}
#endif

}  // namespace

Status writeFile(const fs::path& path, std::span<const std::byte> bytes)
{
	std::error_code code;
	if (path.has_parent_path())
		fs::create_directories(path.parent_path(), code);
	if (code)
		return badInput("{}: its folder cannot be made: {}", path.string(), code.message());
	const fs::path temporary = path.string() + ".part";
	bool named = false;
#ifdef O_TMPFILE
	const Status status = writeNameless(path, temporary, bytes, named);
	if (named)
		return status;
#endif
	return writeBeside(path, temporary, bytes);
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
