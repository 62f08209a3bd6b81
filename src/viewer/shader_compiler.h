// Compiles the shaders again while the program runs.
#pragma once
#include "gpu/pipeline.h"

#include <future>
#include <optional>

namespace tessera::view
{

// GLSL below `folder` to SPIR-V for Vulkan 1.3, as the build does it; includes are found from the folder and from the including file.
// Errors: BadInput with the compiler's text, several lines.
Result<Shader> compileShader(const std::filesystem::path& folder, const std::string& name);

// Watches a folder of sources and compiles on another thread.
class ShaderReloader
{
public:
	explicit ShaderReloader(std::filesystem::path folder) : folder_(std::move(folder)) {}
	~ShaderReloader();

	const std::filesystem::path& folder() const { return folder_; }
	bool hasSources() const;
	bool isCompiling() const { return running_.valid(); }

	// True when a source has changed since the last call that said so, or since the start. Looks at most once a second.
	bool sourcesChanged(double now_s);
	// Starts compiling these, by name ("shading/shade.comp").
	void start(std::vector<std::string> names);
	// All of them when they are compiled, the first error when one is not, nothing while that takes. Never waits.
	std::optional<Result<std::vector<Shader>>> take();

private:
	std::filesystem::path folder_;
	std::filesystem::file_time_type newest_ = std::filesystem::file_time_type::min();
	double looked_s_ = -1;
	bool has_looked_ = false;
	std::future<Result<std::vector<Shader>>> running_;
};

// Where the sources are: beside an installed program's shaders, or where this program was built from.
std::filesystem::path shaderSourceFolder();

}  // namespace tessera::view
