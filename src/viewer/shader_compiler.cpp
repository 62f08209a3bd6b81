#include "viewer/shader_compiler.h"

#include "base/file.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

namespace tessera::view
{

namespace fs = std::filesystem;

namespace
{

Result<std::string> readText(const fs::path& path)
{
	TRY_ASSIGN(const auto bytes, readFile(path));
	return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

class Includer final : public glslang::TShader::Includer
{
public:
	explicit Includer(fs::path folder) : folder_(std::move(folder)) {}

	IncludeResult* includeLocal(const char* header, const char* includer, size_t) override
	{
		for (const fs::path& path : { folder_ / header, folder_ / fs::path(includer).parent_path() / header })
			if (auto text = readText(path))
			{
				auto held = std::make_unique<std::string>(std::move(*text));
				const std::string& kept = *held;
				return new IncludeResult(header, kept.data(), kept.size(), held.release());
			}
		return nullptr;
	}
	void releaseInclude(IncludeResult* result) override
	{
		if (!result)
			return;
		delete static_cast<std::string*>(result->userData);
		delete result;
	}

private:
	fs::path folder_;
};

EShLanguage stageOf(VkShaderStageFlagBits stage)
{
	switch (stage)
	{
	case VK_SHADER_STAGE_MESH_BIT_EXT:
		return EShLangMesh;
	case VK_SHADER_STAGE_VERTEX_BIT:
		return EShLangVertex;
	case VK_SHADER_STAGE_FRAGMENT_BIT:
		return EShLangFragment;
	case VK_SHADER_STAGE_RAYGEN_BIT_KHR:
		return EShLangRayGen;
	case VK_SHADER_STAGE_MISS_BIT_KHR:
		return EShLangMiss;
	case VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR:
		return EShLangClosestHit;
	case VK_SHADER_STAGE_ANY_HIT_BIT_KHR:
		return EShLangAnyHit;
	default:
		return EShLangCompute;
	}
}

void startCompiler()
{
	static std::once_flag once;
	std::call_once(once, [] {
		glslang::InitializeProcess();
		std::atexit(glslang::FinalizeProcess);
	});
}

Result<std::vector<Shader>> compileAll(const fs::path& folder, const std::vector<std::string>& names)
{
	std::vector<Shader> shaders;
	for (const std::string& name : names)
	{
		TRY_ASSIGN(Shader shader, compileShader(folder, name));
		shaders.push_back(std::move(shader));
	}
	return shaders;
}

}  // namespace

Result<Shader> compileShader(const fs::path& folder, const std::string& name)
{
	startCompiler();
	TRY_ASSIGN(const std::string text, readText(folder / name));
	const EShLanguage stage = stageOf(stageOfName(name));
	const char* sources[] = { text.c_str() };
	const char* names[] = { name.c_str() };
	glslang::TShader shader(stage);
	shader.setStringsWithLengthsAndNames(sources, nullptr, names, 1);
	shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
	shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
	shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
	constexpr auto kMessages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
	Includer includer(folder);
	if (!shader.parse(GetDefaultResources(), 100, false, kMessages, includer))
		return badInput("{}", shader.getInfoLog());
	glslang::TProgram program;
	program.addShader(&shader);
	if (!program.link(kMessages))
		return badInput("{}: {}", name, program.getInfoLog());
	Shader compiled = { name, stageOfName(name), {} };
	glslang::GlslangToSpv(*program.getIntermediate(stage), compiled.words);
	return compiled;
}

ShaderReloader::~ShaderReloader()
{
	if (running_.valid())
		running_.wait();
}

bool ShaderReloader::hasSources() const
{
	std::error_code error;
	return !folder_.empty() && fs::is_directory(folder_, error);
}

bool ShaderReloader::sourcesChanged(double now_s)
{
	if (now_s - looked_s_ < 1 || !hasSources())
		return false;
	looked_s_ = now_s;
	fs::file_time_type newest = fs::file_time_type::min();
	std::error_code error;
	for (fs::recursive_directory_iterator entry(folder_, error); !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
	{
		std::error_code ignored;
		if (entry->is_regular_file(ignored))
			newest = std::max(newest, entry->last_write_time(ignored));
	}
	const bool changed = has_looked_ && newest > newest_;
	newest_ = std::max(newest_, newest);
	has_looked_ = true;
	return changed;
}

void ShaderReloader::start(std::vector<std::string> names)
{
	if (!isCompiling())
		running_ = std::async(std::launch::async, [folder = folder_, wanted = std::move(names)] { return compileAll(folder, wanted); });
}

std::optional<Result<std::vector<Shader>>> ShaderReloader::take()
{
	if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
		return {};
	return running_.get();
}

fs::path shaderSourceFolder()
{
	const fs::path installed = shaderFolder().parent_path() / "shader_sources";
	std::error_code error;
	return fs::is_directory(installed, error) ? installed : programFolder().parent_path().parent_path() / "shaders";
}

}  // namespace tessera::view
